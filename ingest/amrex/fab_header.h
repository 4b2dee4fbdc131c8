// The line before a FAB's values: "FAB ((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1)))((0,0,0) (31,31,31)
// (0,0,0)) 3". FABio::write_header and FABio_binary::write_header in AMReX's Src/Base/AMReX_FArrayBox.cpp write it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "format/base/index.h"
#include "ingest/amrex/real_layout.h"
#include "ingest/files/input_file.h"

namespace weir {

/// No such line is longer.
inline constexpr std::size_t kMostFabHeaderBytes = 1024;

struct FabHeader {
  RealLayout layout;
  Box box;
  std::int64_t components = 0;
  std::uint64_t bytes = 0;  ///< of the line, its end included
};

/// `head`: the bytes at `offset` of the file `path`, kMostFabHeaderBytes or up to its end. Throws Error(input) with
/// path and offset where they are no such line, or one of the format before AMReX ("FAB: 8 ...").
FabHeader parse_fab_header(std::string_view head, const std::string& path, std::uint64_t offset);

/// The same of the bytes at `offset` of `file`, which lies before its end. Throws as InputFile's reads, too.
FabHeader read_fab_header(InputFile& file, std::uint64_t offset);

}  // namespace weir
