// The NanoVDB files that a command takes: which, in what order, and what the steps of a series have in common.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// Files as named, and those of a pattern that is no file's name: *, ? and [...], or one %d or %05d in the last part;
/// in natural order (natural_less), each once. Throws Error(input) for a pattern that matches nothing.
std::vector<std::string> expand_volumes(std::span<const std::string> inputs);

/// Where a volume lies in the world.
struct SeriesPlace {
  std::array<double, 3> voxel_size{};
  std::array<double, 3> origin{};  ///< of voxel (0, 0, 0)

  friend bool operator==(const SeriesPlace&, const SeriesPlace&) = default;
};

struct SeriesSummary {
  std::optional<MinMax> range;      ///< union of the finite value ranges
  std::optional<float> background;  ///< of the first file that has a finite one
  /// "a.nvdb has 64 x 64 x 64 voxels from 0,0,0, b.nvdb has 32 x 64 x 64 voxels from 0,0,0": the first two whose index
  /// boxes, or else voxel sizes or origins, differ; empty: none.
  std::string difference;
  std::string without_range{};  ///< the first file that names no finite range; empty: none
  std::string turned{};         ///< the first file that map_warning() warns of, and what it says; empty: none
  std::string first{};          ///< the first file
  std::optional<Box> box{};     ///< its index box
  SeriesPlace place{};
};

/// Adds a file's head to it, which is read alone; where it names no finite range, as of a file with infinities, its
/// certificate, too, or its macrocells. Throws Error(input) where the head is missing, damaged or says more bytes than
/// the file has, and changes nothing then.
void add_to_summary(SeriesSummary& summary, const std::string& path);

/// Adds a file's background and range of values, as its root has them: finite or not.
void add_values(SeriesSummary& summary, float background, const MinMax& range);

/// Reads the heads of all files. Those that cannot be read are left out: they are errors when their turn comes.
SeriesSummary summarise_series(std::span<const std::string> files);

}  // namespace weir
