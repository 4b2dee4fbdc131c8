// `Level_k/Cell_H` of an AMReX plotfile: the boxes of a level, where their values lie, and what range they have. The
// layout is that of VisMF::Header in AMReX's Src/Base/AMReX_VisMF.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "ingest/amrex/plotfile_text.h"
#include "ingest/amrex/real_layout.h"

namespace weir {

/// A box of cells in 24 bytes: there may be millions.
struct CellBox {
  std::array<std::int32_t, 3> lo;
  std::array<std::int32_t, 3> last;  ///< inclusive

  Box box() const {
    return {{lo[0], lo[1], lo[2]}, {std::int64_t{last[0]} + 1, std::int64_t{last[1]} + 1, std::int64_t{last[2]} + 1}};
  }
};

/// Where a FAB lies, the values of one box: all cells of its first component, x fastest, then those of the next.
struct FabPlace {
  std::uint64_t offset = 0;  ///< bytes before it
  std::uint32_t file = 0;    ///< position in CellHeader::files
};

struct ComponentRange {
  double min = 0;
  double max = 0;
};

/// Which of them a header keeps.
struct RangesKept {
  bool of_components = false;           ///< CellHeader::ranges
  std::optional<std::size_t> of_boxes;  ///< CellHeader::box_ranges: those of this component
};

struct CellHeader {
  std::int64_t components = 0;
  std::vector<CellBox> boxes;
  std::vector<FabPlace> places;            ///< of each box
  std::vector<std::string> files;          ///< names, in the directory of Cell_H
  std::vector<ComponentRange> ranges;      ///< of each component over all boxes; empty where the file does not say
  std::vector<ComponentRange> box_ranges;  ///< of one component in each box; empty where the file does not say
  std::optional<RealLayout> layout;        ///< where it is said here and the FABs have no headers of their own
};

/// What a box costs in memory, the index over it (BoxIndex) and the range of one component included.
inline constexpr std::uint64_t kBytesPerBox = 88;

/// `bytes`: of the whole text, which bounds how many boxes there can be. Takes at most `memory` bytes, else throws
/// Error(usage) that names a sufficient --memory. Throws Error(input) for ghost cells, boxes not of cells, files
/// outside the directory, and whatever is damaged.
CellHeader parse_cell_header(PlotfileText& text, std::uint64_t bytes, std::uint64_t memory, const RangesKept& kept);

}  // namespace weir
