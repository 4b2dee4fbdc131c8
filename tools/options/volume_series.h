// The NanoVDB files that a command takes, their order, and what the steps of a series have in common.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"

namespace weir {

/// Returns the named files and the files that match a pattern: *, ? and [...], or one %d or %05d in the last part. A
/// name that exists is not taken as a %d pattern. The result is in natural order (natural_less), each file once.
/// Throws Error(input) for a pattern that matches nothing.
std::vector<std::string> expand_volumes(std::span<const std::string> inputs);

/// Voxel size and position of a volume in the world.
struct SeriesPlace {
  std::array<double, 3> voxel_size{};
  std::array<double, 3> origin{};  ///< position of voxel (0, 0, 0)

  friend bool operator==(const SeriesPlace&, const SeriesPlace&) = default;
};

struct SeriesSummary {
  std::optional<MinMax> range;      ///< union of the finite value ranges
  std::optional<float> background;  ///< background of the first file that has a finite one
  /// The first difference of index boxes, voxel sizes or origins between two files; empty: none. "a.nvdb has 64 x 64 x
  /// 64 voxels from 0,0,0, b.nvdb has 32 x 64 x 64 voxels from 0,0,0".
  std::string difference;
  std::string without_range{};  ///< the first file without a finite range; empty: none
  std::string turned{};         ///< the first file that map_warning() warns of, and the warning; empty: none
  std::string first{};          ///< the first file
  std::optional<Box> box{};     ///< index box of the first file
  SeriesPlace place{};
};

/// Adds the head of one file to `summary`; only the head is read. If the head names no finite range, as in a file with
/// infinities, the certificate or the stored macrocells are read too. Throws Error(input), and changes nothing, if the
/// head is missing or damaged or names more bytes than the file has.
void add_to_summary(SeriesSummary& summary, const std::string& path);

/// Adds a file's background and value range, as its root holds them: finite or not.
void add_values(SeriesSummary& summary, float background, const MinMax& range);

/// Reads the heads of all files. Files that cannot be read are left out; they are reported when they are opened in
/// their turn.
SeriesSummary summarise_series(std::span<const std::string> files);

}  // namespace weir
