// `Level_k/Cell_H` of an AMReX plotfile: the boxes of a level, the places of their values, and the ranges of these
// values. The layout is that of VisMF::Header in AMReX's Src/Base/AMReX_VisMF.cpp.
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

/// A box of cells in 24 bytes, because there may be millions of boxes.
struct CellBox {
  std::array<std::int32_t, 3> lo;
  std::array<std::int32_t, 3> last;  ///< inclusive

  Box box() const {
    return {{lo[0], lo[1], lo[2]}, {std::int64_t{last[0]} + 1, std::int64_t{last[1]} + 1, std::int64_t{last[2]} + 1}};
  }
};

/// The place of a FAB, which holds the values of one box: all cells of the first component, x fastest, then the next
/// component.
struct FabPlace {
  std::uint64_t offset = 0;  ///< bytes before it in the file
  std::uint32_t file = 0;    ///< position in CellHeader::files
};

struct ComponentRange {
  double min = 0;
  double max = 0;
};

/// The ranges that a header keeps.
struct RangesKept {
  bool of_components = false;           ///< CellHeader::ranges
  std::optional<std::size_t> of_boxes;  ///< CellHeader::box_ranges: the ranges of this component
};

struct CellHeader {
  std::int64_t components = 0;
  std::vector<CellBox> boxes;
  std::vector<FabPlace> places;            ///< one for each box
  std::vector<std::string> files;          ///< names of files in the directory of Cell_H
  std::vector<ComponentRange> ranges;      ///< of each component over all boxes; empty if the file does not have them
  std::vector<ComponentRange> box_ranges;  ///< of one component in each box; empty if the file does not have them
  std::optional<RealLayout> layout;        ///< set if the header gives it and FABs have no headers of their own
};

/// Memory for one box, in bytes, including the index over it (BoxIndex) and the range of one component.
inline constexpr std::uint64_t kBytesPerBox = 88;

/// Parses a Cell_H. `bytes` is the size of the whole text, which bounds the number of boxes. Throws Error(usage) that
/// names a sufficient --memory if the boxes need more than `memory` bytes. Throws Error(input) for ghost cells, boxes
/// that are not of cells, files outside the directory, and damaged text.
CellHeader parse_cell_header(PlotfileText& text, std::uint64_t bytes, std::uint64_t memory, const RangesKept& kept);

}  // namespace weir
