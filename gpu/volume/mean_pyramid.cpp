#include "gpu/volume/mean_pyramid.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <array>
#include <cstddef>

#include "format/leaf/leaf_decode.h"
#include "gpu/volume/level_bounds.h"
#include "gpu/volume/voxel_mean.h"

namespace weir {
namespace {

using BlockValues = std::array<float, kLeafVoxels>;

// A block's values; of one with one value, only the first is set, and true is returned.
struct TableBlocks {
  LeafTableView table;

  bool read(const Int3& at, BlockValues& values) const {
    const LeafBlock block = table.block({8 * at.x, 8 * at.y, 8 * at.z});
    if (block.leaf == nullptr) {
      values[0] = block.value;
      return true;
    }
    for (std::uint32_t i = 0; i < kLeafVoxels; ++i) values[i] = leaf_value(table.type, block.leaf, i);
    return false;
  }
};

struct DenseBlocks {
  DenseView voxels;
  Int3 shift;  // voxels from the first block's corner to the domain's

  // Those outside the domain are not looked at.
  bool read(const Int3& at, BlockValues& values) const {
    const Int3 low{8 * at.x - shift.x, 8 * at.y - shift.y, 8 * at.z - shift.z};
    for (std::int32_t i = 0; i < kLeafVoxels; ++i) {
      values[static_cast<std::size_t>(i)] = voxels.voxel({clamped(low.x + (i >> 6), 0, voxels.extent.x - 1),
                                                          clamped(low.y + (i >> 3 & 7), 0, voxels.extent.y - 1),
                                                          clamped(low.z + (i & 7), 0, voxels.extent.z - 1)});
    }
    return false;
  }
};

struct PackedBlocks {
  const CachedBlocks& blocks;

  bool read(const Int3& at, BlockValues& values) const { return blocks.read(at, values); }
};

// A group of one thread.
struct LoneThread {
  unsigned index() const { return 0; }
  unsigned count() const { return 1; }
  MinMax widest(const MinMax& own, MinMax* /*of_warps*/) const { return own; }
};

Int3 blocks_of(const Int3& voxels) { return {voxels.x >> 3, voxels.y >> 3, voxels.z >> 3}; }

// Adds the voxels [low, high) of the domain's first region's lattice that lie in `block`.
void add_block(VoxelMean& mean, const BlockValues& values, bool one_value, const Int3& block, const Int3& low,
               const Int3& high) {
  const auto in_block = [](std::int32_t v, std::int32_t b) { return clamped(v - 8 * b, 0, 8); };
  const Int3 from{in_block(low.x, block.x), in_block(low.y, block.y), in_block(low.z, block.z)};
  const Int3 to{in_block(high.x, block.x), in_block(high.y, block.y), in_block(high.z, block.z)};
  if (one_value) {
    mean.add(values[0], static_cast<double>((to.x - from.x) * (to.y - from.y) * (to.z - from.z)));
  } else {
    mean.add(values.data(), from, to);
  }
}

}  // namespace

MeanPyramid::MeanPyramid(const Box& domain, const LeafTableView& table, int first, int threads)
    : lattice_(level_lattice(domain)), first_(first) {
  fill(TableBlocks{table}, threads);
}

MeanPyramid::MeanPyramid(const Box& domain, const CachedBlocks& blocks, int first, int threads)
    : lattice_(level_lattice(domain)), first_(first) {
  fill(PackedBlocks{blocks}, threads);
}

MeanPyramid::MeanPyramid(const Box& domain, const DenseView& voxels, int first, int threads)
    : lattice_(level_lattice(domain)), first_(first) {
  const Int3& shift = lattice_.shift;
  fill(DenseBlocks{voxels, {shift.x & 7, shift.y & 7, shift.z & 7}}, threads);
}

// Work is split by the blocks' columns in z, or by the texels of which they are parts, so that a block is read once.
template <class Blocks>
void MeanPyramid::fill(const Blocks& blocks, int threads) {
  const int count = level_count(lattice_, first_);
  for (int l = first_; l < first_ + count; ++l) levels_.emplace_back(lattice_.size(l));
  const int unit = greater(first_, 3);  // level whose texels are filled together
  const Int3 units = lattice_.texels(unit);
  const Int3 corner = blocks_of(lattice_.shift);  // the table's first block
  const Int3 first_unit = lattice_.first(unit);
  const Int3 first_texel = lattice_.first(first_);
  const Int3 texels = lattice_.texels(first_);
  const int parts = unit - first_;  // 2^parts texels a unit, along an axis
  std::vector<float>& finest = levels_.front();

  const auto fill_unit = [&](const Int3& u) {
    Int3 low;
    Int3 high;
    lattice_.voxels(u, unit, low, high);
    const Int3 from = blocks_of(low);
    const Int3 to = blocks_of({high.x - 1, high.y - 1, high.z - 1});
    BlockValues values{};
    VoxelMean whole;
    for (std::int32_t x = from.x; x <= to.x; ++x) {
      for (std::int32_t y = from.y; y <= to.y; ++y) {
        for (std::int32_t z = from.z; z <= to.z; ++z) {
          const Int3 block{x, y, z};
          const bool one_value = blocks.read({x - corner.x, y - corner.y, z - corner.z}, values);
          if (parts == 0) {
            add_block(whole, values, one_value, block, low, high);
            continue;
          }
          for (std::int32_t k = 0; k < 1 << (3 * parts); ++k) {
            const std::int32_t mask = (1 << parts) - 1;
            const Int3 texel{((first_unit.x + u.x) << parts) + (k & mask) - first_texel.x,
                             ((first_unit.y + u.y) << parts) + (k >> parts & mask) - first_texel.y,
                             ((first_unit.z + u.z) << parts) + (k >> 2 * parts) - first_texel.z};
            if (texel.x < 0 || texel.y < 0 || texel.z < 0) continue;
            if (texel.x >= texels.x || texel.y >= texels.y || texel.z >= texels.z) continue;
            Int3 begin;
            Int3 end;
            lattice_.voxels(texel, first_, begin, end);
            VoxelMean mean;
            add_block(mean, values, one_value, block, begin, end);
            finest[table_index(texel, texels)] = mean.value();
          }
        }
      }
    }
    if (parts == 0) finest[table_index(u, texels)] = whole.value();
  };

  oneapi::tbb::task_arena arena(threads > 0 ? threads : oneapi::tbb::task_arena::automatic);
  arena.execute([&] {
    const std::int64_t columns = std::int64_t{units.x} * units.y;
    oneapi::tbb::parallel_for(std::int64_t{0}, columns, [&](std::int64_t c) {
      for (std::int32_t z = 0; z < units.z; ++z) {
        fill_unit({static_cast<std::int32_t>(c % units.x), static_cast<std::int32_t>(c / units.x), z});
      }
    });
    for (int l = first_ + 1; l < first_ + count; ++l) {
      const std::vector<float>& finer = levels_[static_cast<std::size_t>(l - 1 - first_)];
      std::vector<float>& coarser = levels_[static_cast<std::size_t>(l - first_)];
      const Int3 n = lattice_.texels(l);
      oneapi::tbb::parallel_for(0, n.z, [&](std::int32_t z) {
        for (std::int32_t y = 0; y < n.y; ++y) {
          for (std::int32_t x = 0; x < n.x; ++x) {
            coarser[table_index({x, y, z}, n)] = coarser_texel(lattice_, l - 1, finer.data(), {x, y, z});
          }
        }
      });
    }
  });
}

LevelsView<DenseSampler> MeanPyramid::view() const {
  LevelsView<DenseSampler> view;
  view.lattice = lattice_;
  view.first = first_;
  view.count = static_cast<int>(levels_.size());
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    view.texels[l] = {{levels_[l].data(), lattice_.texels(first_ + static_cast<int>(l))}, Filter::trilinear};
  }
  return view;
}

std::vector<MinMax> MeanPyramid::bounds(const MacrocellGrid& cells, const LevelChoice& choice, int threads,
                                        bool drafts) const {
  std::vector<MinMax> result(cells.bounds().size());
  LevelBounds<DenseView> step;
  step.lattice = lattice_;
  step.first = first_;
  step.count = static_cast<int>(levels_.size());
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    step.texels[l] = {levels_[l].data(), lattice_.texels(first_ + static_cast<int>(l))};
  }
  step.choice = choice;
  step.drafts = drafts;
  step.cells = cells.lattice();
  step.voxels = cells.bounds().data();
  step.bounds = result.data();
  oneapi::tbb::task_arena arena(threads > 0 ? threads : oneapi::tbb::task_arena::automatic);
  arena.execute([&] {
    oneapi::tbb::parallel_for(std::size_t{0}, result.size(), [&](std::size_t i) {
      LevelBounds<DenseView>::Shared unused;
      step(LoneThread{}, unused, static_cast<std::uint32_t>(i));
    });
  });
  return result;
}

}  // namespace weir
