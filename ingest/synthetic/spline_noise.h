// Band-limited noise: octaves of hashed lattice values under a cubic B-spline.
// The spline is C2, its weights are positive and sum to one, so that the values
// of the lattice nodes around a box bound the noise inside it.
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
  std::uint64_t key = 0;  ///< of the node hash
  /// Voxels, multiples of kTileDim: a tile lies in one cell of a long period and in whole cells of a
  /// short one, which fixes every trip count, and long periods still do not share their nodes.
  Index3 offset;
};

class SplineNoise {
 public:
  static constexpr unsigned kFinestShift = 2;
  static constexpr unsigned kCoarsestShift = 10;

  /// Octaves with periods from the power of two next to a quarter of the extent's longest axis, at
  /// most 2^kCoarsestShift, down to 2^kFinestShift voxels; each has `gain` times the amplitude of
  /// the one before, and together they have the standard deviation `deviation`.
  SplineNoise(std::uint64_t seed, const Index3& extent, float gain, float deviation);

  std::span<const NoiseOctave> octaves() const { return octaves_; }
  /// No value exceeds it anywhere.
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
  std::array<const float*, 4> x_weights{};  ///< kTileDim of each tap, periodic
};

/// The noise in one tile. Work is shared between voxels by interpolating z once per plane, y once per
/// row and x once per voxel.
class TileNoise {
 public:
  /// `box` is a Tile's: within one aligned run of kTileDim voxels in x.
  TileNoise(const SplineNoise& noise, const Box& box);

  /// No value in the box exceeds it.
  float upper_bound() const { return upper_bound_; }
  /// Makes `z` the plane of add_row. Returns a bound that no value in it exceeds.
  float set_plane(std::int64_t z);
  /// Adds the noise of row `y` to `values`: box.extent().x floats.
  void add_row(std::int64_t y, float* values) const;

 private:
  Box box_;
  std::vector<NoiseLattice> lattices_;
  float upper_bound_ = 0;
};

}  // namespace weir
