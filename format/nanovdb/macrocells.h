// Macrocells: bounds of the decoded values over cells of kMacrocell^3 voxels and an apron of one voxel around each, so
// that a majorant taken from a cell holds for every filtered lookup in it. Stored as the grid's blind data:
//   name  "weir_macrocells:CELL:APRON" (NUL padded), type float, 2 values (min, max) a cell
//   order x fastest, cells of the lattice make_lattice(index bounding box, CELL)
// Voxels outside the domain count as the background.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "format/base/index.h"
#include "format/leaf/bounds.h"

namespace weir {

inline constexpr std::int64_t kMacrocell = 16;      ///< voxels along a cell's edge
inline constexpr std::int64_t kMacrocellApron = 1;  ///< voxels

struct MacrocellName {
  std::int64_t cell = kMacrocell;
  std::int64_t apron = kMacrocellApron;
};

/// Returns "weir_macrocells:16:1".
std::string macrocell_name(const MacrocellName& shape);
/// Parses a name of macrocell_name(). Returns nullopt if the text is not such a name, if cell is not a multiple of 8 in
/// [8, 4096], or if apron is not in [0, 8].
std::optional<MacrocellName> parse_macrocell_name(std::string_view text);

/// Macrocells of the decoded values, see FORMAT.md: min and max over each cell and `apron` voxels around it. `cells` is
/// empty if the file has none, or has them not aligned to 4 bytes.
struct MacrocellView {
  std::int64_t cell = 0;          ///< voxels along an edge
  std::int64_t apron = 0;         ///< voxels
  NodeLattice lattice;            ///< cells over the index bounding box
  std::span<const MinMax> cells;  ///< lattice.size() entries, x fastest
};

}  // namespace weir
