// The line before a FAB's values: "FAB ((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2 1)))((0,0,0) (31,31,31)
// (0,0,0)) 3". AMReX writes it in FABio::write_header and FABio_binary::write_header, Src/Base/AMReX_FArrayBox.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "format/base/index.h"
#include "ingest/amrex/real_layout.h"
#include "ingest/files/input_file.h"

namespace weir {

/// The most bytes of a FAB header's line.
inline constexpr std::size_t kMostFabHeaderBytes = 1024;

struct FabHeader {
  RealLayout layout;
  Box box;
  std::int64_t components = 0;
  std::uint64_t bytes = 0;  ///< of the line, including its line end
};

/// Parses `head`, the bytes at `offset` of the file `path`: kMostFabHeaderBytes of them, or up to the file's end.
/// Throws Error(input) with path and offset if they are not such a line, or are in the format before AMReX ("FAB: 8
/// ...").
FabHeader parse_fab_header(std::string_view head, const std::string& path, std::uint64_t offset);

/// Reads and parses the bytes at `offset` of `file`; `offset` must lie before its end. Also throws the errors of
/// InputFile's reads.
FabHeader read_fab_header(InputFile& file, std::uint64_t offset);

}  // namespace weir
