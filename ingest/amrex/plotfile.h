// An AMReX plotfile as it lies on disk: a directory with Header, Level_k/Cell_H and files of FABs. Opened here, checked
// as a whole, and no value of it read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "ingest/amrex/amrex_header.h"
#include "ingest/amrex/box_index.h"
#include "ingest/amrex/cell_header.h"
#include "ingest/amrex/interruption.h"
#include "ingest/amrex/real_layout.h"
#include "ingest/files/file_states.h"

namespace weir {

/// One level, its boxes in cells from the first of its domain on.
struct PlotfileLevel {
  Index3 extent;          ///< of the domain, cells
  Index3 ratio{1, 1, 1};  ///< its cells along one of the level below
  std::string directory;  ///< of its files
  std::vector<CellBox> boxes;
  std::vector<FabPlace> places;
  std::vector<std::string> files;
  std::vector<ComponentRange> ranges;
  std::vector<ComponentRange> box_ranges;
  bool bare = false;  ///< FABs have no headers: values begin at their offsets
  BoxIndex index;

  std::string path(std::uint32_t file) const { return directory + '/' + files[file]; }
  std::uint64_t cells(std::size_t box) const { return static_cast<std::uint64_t>(boxes[box].box().voxels()); }
};

struct Plotfile {
  std::string path;  ///< as it was asked for, without a slash at its end
  AmrexHeader header;
  RealLayout layout;                  ///< of all FABs
  std::vector<PlotfileLevel> levels;  ///< as many as were opened
  FileStates files;                   ///< all of them
  std::uint64_t bytes = 0;            ///< of all of them
  std::int64_t mtime_ns = 0;          ///< of the one written last
};

/// The directory of a plotfile, of which its Header may be named, too.
std::string plotfile_directory(const std::string& path);

/// A box of a level, as that level's Cell_H has it: "(0,0,0) to (7,7,3)".
std::string box_in_file(const Plotfile& plotfile, std::size_t level, std::uint32_t box);

/// "plt00042/Level_0/Cell_H".
std::string cell_header_path(const Plotfile& plotfile, std::size_t level);

/// Its header alone. Throws Error(interrupted), too.
AmrexHeader read_amrex_header(const std::string& path, Interruption interruption);

struct PlotfileParts {
  std::size_t levels = SIZE_MAX;      ///< the coarsest ones, as many of them
  std::uint64_t memory = UINT64_MAX;  ///< bytes, for boxes and indices over them
  RangesKept ranges;
  Interruption interruption = nullptr;  ///< ends opening with Error(interrupted)
};

/// Opens it. Throws Error(input) with path and place for what is damaged, missing or cut: a FAB file is there and long
/// enough for the last of its FABs; FABs without headers have no byte in common; boxes lie in their domain and have no
/// cell in common; level 0 covers it. Error(usage) where the boxes take more than `parts.memory`.
Plotfile open_plotfile(const std::string& path, const PlotfileParts& parts);

}  // namespace weir
