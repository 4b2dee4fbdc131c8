// The files of a series that is played: which, in what order, and what they
// have in common.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// Text order with runs of digits as numbers: "step_9" before "step_10".
bool natural_less(std::string_view a, std::string_view b);

/// Files as named, and those that a pattern (*, ?, [...]) which is no file's name matches; in natural order,
/// each once. Throws Error(input) for a pattern that matches nothing.
std::vector<std::string> expand_volumes(std::span<const std::string> inputs);

struct SeriesSummary {
  std::optional<MinMax> range;      ///< union of the finite value ranges
  std::optional<float> background;  ///< of the first file that has a finite one
  /// "a.nvdb has 64 x 64 x 64 voxels, b.nvdb 32 x 64 x 64": the first two whose index boxes differ; empty: none.
  std::string difference;
};

/// Reads the heads of all files. Those that cannot be read are left out: they are errors when their turn comes.
SeriesSummary summarise_series(std::span<const std::string> files);

}  // namespace weir
