// The NanoVDB files that a command takes: which, in what order, and what the steps of a series have in common.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// Files as named, and those of a pattern that is no file's name: *, ? and [...], or one %d or %05d in the last part;
/// in natural order (natural_less), each once. Throws Error(input) for a pattern that matches nothing.
std::vector<std::string> expand_volumes(std::span<const std::string> inputs);

struct SeriesSummary {
  std::optional<MinMax> range;      ///< union of the finite value ranges
  std::optional<float> background;  ///< of the first file that has a finite one
  /// "a.nvdb has 64 x 64 x 64 voxels, b.nvdb 32 x 64 x 64": the first two whose index boxes differ; empty: none.
  std::string difference;
  std::string first{};       ///< the first file, in the words of `difference`
  std::optional<Box> box{};  ///< its index box
};

/// Adds a file's head to it, which is read alone. Throws Error(input) where the head is missing, damaged or says more
/// bytes than the file has, and changes nothing then.
void add_to_summary(SeriesSummary& summary, const std::string& path);

/// Adds a file's background and range of values, as its root has them: finite or not.
void add_values(SeriesSummary& summary, float background, const MinMax& range);

/// Reads the heads of all files. Those that cannot be read are left out: they are errors when their turn comes.
SeriesSummary summarise_series(std::span<const std::string> files);

}  // namespace weir
