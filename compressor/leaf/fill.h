// What a dropped block reads as.
#pragma once

#include <bit>
#include <cstdint>
#include <utility>

#include "compressor/leaf/leaf_row.h"

namespace weir {

enum class FillMode { mean, background };

/// What becomes of NaN and infinite voxels: an error before anything is written, the background, or
/// kept as they are (their leaves are then always kept). Missing voxels (MissingPolicy) that are read as such are NaN
/// where those are kept, and the background otherwise.
enum class NonFinitePolicy { error, background, keep };

struct Fill {
  FillMode mode = FillMode::mean;
  float background = 0;
  NonFinitePolicy non_finite = NonFinitePolicy::error;
  /// Missing voxels are inactive, and read the background (ValueMapping::gaps): no tile stands for some of them and for
  /// others. NaN and infinite values that are stored are active: their leaves are always kept.
  bool gaps = false;

  /// Value of the tile that replaces a leaf.
  float leaf_value(const LeafRow& row) const {
    return mode == FillMode::background || row.finite == 0 ? background : row.mean;
  }
  static bool same_bits(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }
  /// True where a tile of `value` reads every finite value bit for bit.
  static bool keeps_values(const LeafRow& row, float value) {
    return row.finite == 0 || (row.uniform() && same_bits(row.mean, value));
  }
  /// True where a tile of `value` reads bit for bit what a kept leaf of `voxels` in-domain voxels would, those without
  /// a value included.
  bool exact(const LeafRow& row, std::int64_t voxels, float value) const {
    return keeps_values(row, value) &&
           (row.finite == voxels || (non_finite != NonFinitePolicy::keep && same_bits(background, value)));
  }
  /// Whether a leaf has to be kept for its active voxels that are not finite.
  bool keeps_active(const LeafRow& row) const { return gaps && row.non_finite != 0; }
  /// Whether a node over `voxels`, in the domain or not, `finite` of which have values, must not become one tile.
  bool splits(std::uint64_t finite, std::int64_t voxels) const {
    return gaps && finite > 0 && std::cmp_less(finite, voxels);
  }
  /// Dropped blocks inside the domain are active tiles where they carry a mean; background is inactive.
  bool active() const { return mode == FillMode::mean; }
  /// `valued`: whether any voxel has a value.
  bool active(bool valued) const { return active() && (valued || !gaps); }
};

}  // namespace weir
