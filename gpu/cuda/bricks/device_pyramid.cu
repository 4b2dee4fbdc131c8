#include "gpu/cuda/bricks/brick_texels.h"
#include "gpu/cuda/bricks/device_machine.cuh"
#include "gpu/cuda/bricks/device_pyramid.h"
#include "gpu/cuda/bricks/level_builder.h"
#include "gpu/volume/level_bounds.h"

namespace weir {

namespace {

// Reads a level's texels unfiltered, because a filtered look-up next to a NaN is NaN.
struct LevelTexels {
  cudaSurfaceObject_t surface;

  __device__ float voxel(const Int3& i) const {
    return surf3Dread<float>(surface, i.x * static_cast<std::int32_t>(sizeof(float)), i.y, i.z);
  }
};

}  // namespace

// While a level is written to its texture, it is in memory twice.
int DevicePyramid::finest_within(const LevelLattice& lattice, int wanted, std::uint64_t bytes) {
  return finest_level_within(lattice, wanted, bytes > kDecodedRegionBytes ? (bytes - kDecodedRegionBytes) / 2 : 0,
                             kMaxTextureEdge);
}

DevicePyramid::DevicePyramid(BlockSource& source, std::span<const RegionEntry> regions, int first, std::uint64_t bytes)
    : lattice_{source.lattice().shift, source.lattice().extent}, first_(first) {
  const DeviceMachine machine;
  const std::uint64_t texels = 2 * level_bytes(lattice_, first);
  DeviceArray<float> level =
      finest_level_of(machine, source, regions, lattice_, first, bytes > texels ? bytes - texels : 0);
  const int count = level_count(lattice_, first);
  for (int i = 0; i < count; ++i) {
    if (i > 0) level = coarser_level_of(machine, lattice_, first + i - 1, level.data());
    levels_.emplace_back(lattice_.texels(first + i));
    write_level(machine, lattice_.texels(first + i), level.data(), SurfaceTexels<float>{levels_.back().surface()});
  }
  machine.wait();
}

LevelsView<TextureSampler> DevicePyramid::view() const {
  LevelsView<TextureSampler> view;
  view.lattice = lattice_;
  view.first = first_;
  view.count = static_cast<int>(levels_.size());
  for (std::size_t i = 0; i < levels_.size(); ++i) view.texels[i] = {levels_[i].object(), false};
  return view;
}

DeviceArray<MinMax> DevicePyramid::bounds(const CellLattice& cells, const MinMax* voxels, const LevelChoice& choice,
                                          bool drafts) const {
  DeviceArray<MinMax> result(static_cast<std::size_t>(cells.size()));
  LevelBounds<LevelTexels> step;
  step.lattice = lattice_;
  step.first = first_;
  step.count = static_cast<int>(levels_.size());
  for (std::size_t i = 0; i < levels_.size(); ++i) step.texels[i] = {levels_[i].surface()};
  step.choice = choice;
  step.drafts = drafts;
  step.cells = cells;
  step.voxels = voxels;
  step.bounds = result.data();
  DeviceMachine().groups(static_cast<std::uint32_t>(result.size()), step);
  return result;
}

}  // namespace weir
