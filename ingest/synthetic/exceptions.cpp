#include "ingest/synthetic/exceptions.h"

#include <limits>

#include "ingest/synthetic/hash.h"
#include "ingest/synthetic/shapes.h"

namespace weir {
namespace {

template <typename Value>
std::unique_ptr<SyntheticField> make_by_voxel(Value value) {
  return std::make_unique<VoxelField<Value>>(value);
}

// Returns a position in [0, count) from the upper bits of a hash.
std::int64_t pick(std::uint64_t bits, std::int64_t count) {
  return static_cast<std::int64_t>((bits >> 1U) % static_cast<std::uint64_t>(count));
}

/// The gradient, with non-finite values at the linear indices that exceptions.h names.
class SomeNonfinite final : public SyntheticField {
 public:
  explicit SomeNonfinite(const SyntheticOptions& options)
      : extent_(options.extent), gradient_(make_gradient(options, 0.0, 1.0)) {}

  void fill(const Tile& tile) const override {
    gradient_->fill(tile);
    const Box& box = tile.box;
    for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
      for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
        float* row = tile.row(y, z);
        std::int64_t phase = linear_index({box.lo.x, y, z}, extent_) % 97;
        for (std::int64_t x = 0; x < box.extent().x; ++x, phase = phase == 96 ? 0 : phase + 1) {
          if (phase == 13) row[x] = std::numeric_limits<float>::quiet_NaN();
          if (phase == 41) row[x] = std::numeric_limits<float>::infinity();
          if (phase == 77) row[x] = -std::numeric_limits<float>::infinity();
        }
      }
    }
  }

 private:
  Index3 extent_;
  std::unique_ptr<SyntheticField> gradient_;
};

/// Fills a tile with ones, then sets the odd voxel of every leaf that touches it.
class NearlyConstant final : public SyntheticField {
 public:
  explicit NearlyConstant(const SyntheticOptions& options)
      : leaves_(make_lattice({{0, 0, 0}, options.extent}, kLeafDim)), key_(derive_key(options.seed, 4)) {}

  void fill(const Tile& tile) const override {
    const Box& box = tile.box;
    ones_->fill(tile);
    const NodeLattice touched = make_lattice(box, kLeafDim);
    for (std::int64_t i = 0; i < touched.size(); ++i) {
      const Index3 leaf = touched.first + touched.position(i);
      const Box voxels = leaves_.voxels(leaf);
      const std::int64_t odd = pick(hash_position(key_, leaf.x, leaf.y, leaf.z), voxels.voxels());
      const Index3 at = voxels.lo + index_at(odd, voxels.extent());
      if (box.contains(at)) tile.row(at.y, at.z)[at.x - box.lo.x] = 2.0F;
    }
  }

 private:
  NodeLattice leaves_;
  std::uint64_t key_;
  std::unique_ptr<SyntheticField> ones_ = make_constant(1.0F);
};

}  // namespace

std::unique_ptr<SyntheticField> make_some_nonfinite(const SyntheticOptions& options) {
  return std::make_unique<SomeNonfinite>(options);
}

std::unique_ptr<SyntheticField> make_hot_voxel(const SyntheticOptions& options) {
  const Index3 hot = index_at(pick(derive_key(options.seed, 3), volume(options.extent)), options.extent);
  return make_by_voxel([hot](std::int64_t x, std::int64_t y, std::int64_t z) {
    return Index3{x, y, z} == hot ? 1.0F : 0.0F;
  });
}

std::unique_ptr<SyntheticField> make_plateau(const SyntheticOptions& options) {
  const std::int64_t third = volume(options.extent) / 3;
  const std::int64_t rest = volume(options.extent) % 3;
  const Index3 up = index_at(third, options.extent);
  const Index3 down = index_at(2 * third + 2 * rest / 3, options.extent);
  return make_by_voxel([up, down](std::int64_t x, std::int64_t y, std::int64_t z) {
    const Index3 i{x, y, z};
    return i == up ? 1e6F : i == down ? -1e6F : 1.0F;
  });
}

std::unique_ptr<SyntheticField> make_checkerboard() {
  return make_by_voxel(
      [](std::int64_t x, std::int64_t y, std::int64_t z) { return static_cast<float>((x + y + z) & 1); });
}

std::unique_ptr<SyntheticField> make_ties(const SyntheticOptions& options) {
  const Index3 extent = options.extent;
  const std::int64_t tied = volume(extent) / 4 * 4;
  return make_by_voxel([extent, tied](std::int64_t x, std::int64_t y, std::int64_t z) {
    const std::int64_t i = linear_index({x, y, z}, extent);
    return i < tied ? 0.125F + 0.25F * static_cast<float>(i & 3) : 0.0F;
  });
}

std::unique_ptr<SyntheticField> make_nearly_constant(const SyntheticOptions& options) {
  return std::make_unique<NearlyConstant>(options);
}

}  // namespace weir
