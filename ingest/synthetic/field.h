// A synthetic volume as a pure function of kind, seed, extent and voxel index: the bits do not depend on the box, the
// number of threads or the order. Only + - * / and sqrt on floats are used. IEEE 754 defines them exactly, so that
// digests hold for every compiler and vector width (-ffp-contract=off).
#pragma once

#include <cstdint>

#include "format/base/index.h"

namespace weir {

struct SyntheticOptions {
  Index3 extent;           ///< voxels, each >= 1
  std::uint64_t seed = 1;  ///< for the kinds with randomness; the others ignore it
};

/// Edge of the pieces in which a box is evaluated. 32^3 floats fit in the second-level cache.
inline constexpr std::int64_t kTileDim = 32;

/// The destination of the voxels of `box`: rows of a larger array, x fastest.
struct Tile {
  Box box;  ///< inside one cube of kTileDim voxels whose corner lies on multiples of kTileDim
  float* first = nullptr;
  std::int64_t row_stride = 0;    ///< floats
  std::int64_t plane_stride = 0;  ///< floats

  float* row(std::int64_t y, std::int64_t z) const {
    return first + (y - box.lo.y) * row_stride + (z - box.lo.z) * plane_stride;
  }
};

class SyntheticField {
 public:
  virtual ~SyntheticField() = default;
  /// Writes every voxel of the tile. Called from several threads at once.
  virtual void fill(const Tile& tile) const = 0;
};

/// The field whose value at (x, y, z) is `value(x, y, z)`, std::int64_t each.
template <typename Value>
class VoxelField final : public SyntheticField {
 public:
  explicit VoxelField(Value value) : value_(value) {}

  void fill(const Tile& tile) const override {
    const Box& box = tile.box;
    for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
      for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
        float* row = tile.row(y, z);
        for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) row[x - box.lo.x] = value_(x, y, z);
      }
    }
  }

 private:
  Value value_;
};

}  // namespace weir
