// An AMReX plotfile on disk: a directory with Header, Level_k/Cell_H and files of FABs. Opening checks all of them,
// but reads no values.
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

/// One level. The cells of its boxes are counted from the first cell of its domain.
struct PlotfileLevel {
  Index3 extent;          ///< of the domain, cells
  Index3 ratio{1, 1, 1};  ///< its cells along one cell of the next coarser level
  std::string directory;  ///< directory of its files
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
  std::string path;  ///< as the user gave it, without a slash at its end
  AmrexHeader header;
  RealLayout layout;                  ///< of all FABs
  std::vector<PlotfileLevel> levels;  ///< the opened levels, coarsest first
  FileStates files;                   ///< Header and all files of the opened levels
  std::uint64_t bytes = 0;            ///< of all `files`
  std::int64_t mtime_ns = 0;          ///< of the one of `files` that was written last
};

/// Returns the directory of a plotfile. `path` may name the directory or its Header.
std::string plotfile_directory(const std::string& path);

/// Returns a box of a level in the indices of that level's Cell_H: "(0,0,0) to (7,7,3)".
std::string box_in_file(const Plotfile& plotfile, std::size_t level, std::uint32_t box);

/// Returns the path of a level's Cell_H: "plt00042/Level_0/Cell_H".
std::string cell_header_path(const Plotfile& plotfile, std::size_t level);

/// Reads only the Header of the plotfile `path`. Also throws Error(interrupted).
AmrexHeader read_amrex_header(const std::string& path, Interruption interruption);

struct PlotfileParts {
  std::size_t levels = SIZE_MAX;      ///< opens this many levels, the coarsest ones
  std::uint64_t memory = UINT64_MAX;  ///< bytes, for the boxes and the indices over them
  RangesKept ranges;
  Interruption interruption = nullptr;  ///< the flag that ends opening with Error(interrupted)
};

/// Opens a plotfile. Throws Error(input) with path and place for anything damaged, missing or cut. Each FAB file must
/// be there and be long enough for its last FAB. FABs without headers must share no byte. Boxes must lie in their
/// domain and share no cell; level 0 must cover its domain. Throws Error(usage) if the boxes take more than
/// `parts.memory`.
Plotfile open_plotfile(const std::string& path, const PlotfileParts& parts);

}  // namespace weir
