// `Header` of an AMReX plotfile: which components and levels there are. The layout is that which AMReX writes in
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

/// One level of refinement, 0 the coarsest.
struct AmrexLevelHeader {
  Box domain;                     ///< in the level's own cells, whose indices may begin below or above 0
  Index3 ratio{1, 1, 1};          ///< cells of this level along one of the level below; 1 of level 0
  std::array<double, 3> spacing;  ///< of its cells, > 0
  std::int64_t boxes = 0;
  std::string cells;  ///< path of its cells' files in the plotfile, without "_H": "Level_0/Cell"
};

struct AmrexHeader {
  std::vector<std::string> components;  ///< names, as in the file
  double time = 0;
  std::array<double, 3> corner;  ///< world position of the lower corner of the domain's first cell
  std::vector<AmrexLevelHeader> levels;
};

/// Whether a text begins as a plotfile's Header does: with a name and a version, "HyperCLaw-V1.1".
bool begins_as_amrex_header(std::string_view text);

/// The ratios are those of the domains, since the file has that of one axis only; it must agree. Throws Error(input)
/// with path and line: 1-D and 2-D plotfiles, coordinates that are not Cartesian, domains that do not refine each
/// other, sizes of cells that fit neither the domain nor each other, and whatever is damaged.
AmrexHeader parse_amrex_header(PlotfileText& text);

}  // namespace weir
