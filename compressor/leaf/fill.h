// The value that a reader gets for a dropped block.
#pragma once

#include <bit>
#include <cstdint>
#include <utility>

#include "compressor/leaf/leaf_row.h"

namespace weir {

enum class FillMode { mean, background };

/// What happens to NaN and infinite voxels. error: an error before anything is written. background: they become the
/// background. keep: they stay as they are, and their leaves are always kept. Missing voxels (MissingPolicy) stay NaN
/// with keep, and become the background otherwise.
enum class NonFinitePolicy { error, background, keep };

struct Fill {
  FillMode mode = FillMode::mean;
  float background = 0;
  NonFinitePolicy non_finite = NonFinitePolicy::error;
  /// Whether missing voxels are inactive and read the background (ValueMapping::gaps). A tile then never covers both
  /// missing and other voxels. Stored NaN and infinite values are active, and their leaves are always kept.
  bool gaps = false;

  /// Returns the value of the tile that replaces a leaf.
  float leaf_value(const LeafRow& row) const {
    return mode == FillMode::background || row.finite == 0 ? background : row.mean;
  }
  static bool same_bits(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }
  /// Returns whether a tile of `value` gives every finite value of the leaf bit for bit.
  static bool keeps_values(const LeafRow& row, float value) {
    return row.finite == 0 || (row.uniform() && same_bits(row.mean, value));
  }
  /// Returns whether a tile of `value` gives bit for bit what a kept leaf of `voxels` in-domain voxels would give,
  /// including the voxels without a value.
  bool exact(const LeafRow& row, std::int64_t voxels, float value) const {
    return keeps_values(row, value) &&
           (row.finite == voxels || (non_finite != NonFinitePolicy::keep && same_bits(background, value)));
  }
  /// Returns whether a leaf must be kept because it has active voxels that are not finite.
  bool keeps_active(const LeafRow& row) const { return gaps && row.non_finite != 0; }
  /// Returns whether a node must not become one tile. `voxels` is the number of its voxels, in the domain or not, and
  /// `finite` the number with finite values.
  bool splits(std::uint64_t finite, std::int64_t voxels) const {
    return gaps && finite > 0 && std::cmp_less(finite, voxels);
  }
  /// Returns whether dropped blocks inside the domain are active tiles: those with a mean are, background is not.
  bool active() const { return mode == FillMode::mean; }
  /// The same for a block; `valued` says whether any of its voxels has a value.
  bool active(bool valued) const { return active() && (valued || !gaps); }
};

}  // namespace weir
