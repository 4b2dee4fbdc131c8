// Band-limited noise: octaves of hashed lattice values, interpolated with a cubic B-spline. The spline is C2, and its
// weights are positive and sum to one. So the lattice values around a box bound the noise inside the box.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ingest/synthetic/field.h"

namespace weir {

/// One octave: nodes every 2^shift voxels with values in [-amplitude, amplitude).
struct NoiseOctave {
  unsigned shift = 0;  ///< log2 of the period in voxels, kFinestShift ... kCoarsestShift
  float amplitude = 0;
  std::uint64_t key = 0;  ///< key of the node hash
  /// Voxels, multiples of kTileDim. A tile then lies in one cell of a long period and in whole cells of a short one,
  /// which fixes every trip count. Long periods still do not share their nodes.
  Index3 offset;
};

class SplineNoise {
 public:
  static constexpr unsigned kFinestShift = 2;
  static constexpr unsigned kCoarsestShift = 10;

  /// Makes octaves with periods from about a quarter of the extent's longest axis (a power of two, at most
  /// 2^kCoarsestShift) down to 2^kFinestShift voxels. Each octave has `gain` times the amplitude of the one before.
  /// Together they have the standard deviation `deviation`.
  SplineNoise(std::uint64_t seed, const Index3& extent, float gain, float deviation);

  std::span<const NoiseOctave> octaves() const { return octaves_; }
  /// An upper bound of all noise values.
  float amplitude_sum() const { return amplitude_sum_; }

 private:
  std::vector<NoiseOctave> octaves_;
  float amplitude_sum_ = 0;
};

/// The nodes that one octave needs for a tile, interpolated one axis at a time.
struct NoiseLattice {
  NoiseOctave octave;
  Index3 first;                             ///< node coordinate of nodes[0]
  Index3 count;                             ///< nodes along each axis; x padded to a multiple of four
  std::vector<float> nodes;                 ///< x fastest
  std::vector<float> plane;                 ///< nodes interpolated in z
  std::array<const float*, 4> x_weights{};  ///< kTileDim weights of each tap, periodic
};

/// The noise in one tile. Interpolates z once per plane, y once per row and x once per voxel, so that voxels share
/// work.
class TileNoise {
 public:
  /// `box` must be a Tile's box: in x, within one aligned run of kTileDim voxels.
  TileNoise(const SplineNoise& noise, const Box& box);

  /// An upper bound of the values in the box.
  float upper_bound() const { return upper_bound_; }
  /// Makes `z` the plane of add_row(). Returns an upper bound of the values in the plane.
  float set_plane(std::int64_t z);
  /// Adds the noise of row `y` to `values`: box.extent().x floats.
  void add_row(std::int64_t y, float* values) const;

 private:
  Box box_;
  std::vector<NoiseLattice> lattices_;
  float upper_bound_ = 0;
};

}  // namespace weir
