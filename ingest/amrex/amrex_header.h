// `Header` of an AMReX plotfile: its components and levels. AMReX writes this layout in
// Src/Base/AMReX_PlotFileUtil.cpp (WriteGenericPlotfileHeader) and Src/Amr/AMReX_AmrLevel.cpp (writePlotFilePre).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/index.h"
#include "ingest/amrex/plotfile_text.h"

namespace weir {

/// One level of refinement; level 0 is the coarsest.
struct AmrexLevelHeader {
  Box domain;                     ///< in the level's own cells; indices may begin below or above 0
  Index3 ratio{1, 1, 1};          ///< cells of this level along one cell of the next coarser level; 1 for level 0
  std::array<double, 3> spacing;  ///< size of its cells, > 0
  std::int64_t boxes = 0;
  std::string cells;  ///< path, in the plotfile, of its cells' files, without "_H": "Level_0/Cell"
};

struct AmrexHeader {
  std::vector<std::string> components;  ///< names, as in the file
  double time = 0;
  std::array<double, 3> corner;  ///< world position of the lower corner of the domain's first cell
  std::vector<AmrexLevelHeader> levels;
};

/// Returns whether a text begins like a plotfile's Header: with a name and a version, "HyperCLaw-V1.1".
bool begins_as_amrex_header(std::string_view text);

/// Parses a Header. Ratios are computed from the domains, because the file may give only the ratio along the first
/// axis; the file's ratio must agree. Throws Error(input) with path and line for 1-D and 2-D plotfiles, coordinates
/// that are not Cartesian, domains that do not refine each other, cell sizes that fit neither the domain nor each
/// other, and damaged text.
AmrexHeader parse_amrex_header(PlotfileText& text);

}  // namespace weir
