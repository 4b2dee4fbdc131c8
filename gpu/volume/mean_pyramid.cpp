#include "gpu/volume/mean_pyramid.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <array>
#include <cstddef>
#include <utility>

#include "format/leaf/leaf_decode.h"
#include "gpu/volume/level_bounds.h"
#include "gpu/volume/voxel_mean.h"

namespace weir {
namespace {

using BlockValues = std::array<float, kLeafVoxels>;

// Reads a block's values. If the block has one value, only the first is set and true is returned.
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

  // Voxels outside the domain are never used; they are filled with the nearest inside.
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

// A group that consists of one thread.
struct LoneThread {
  unsigned index() const { return 0; }
  unsigned count() const { return 1; }
  MinMax widest(const MinMax& own, MinMax* /*of_warps*/) const { return own; }
};

Int3 blocks_of(const Int3& voxels) { return {voxels.x >> 3, voxels.y >> 3, voxels.z >> 3}; }

// Adds the voxels [low, high) that lie in `block`, counted from the corner of the domain's first region.
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

// Calls take(i) for all i in [low, high).
template <class Take>
void for_each_in(const Int3& low, const Int3& high, const Take& take) {
  for (std::int32_t x = low.x; x < high.x; ++x) {
    for (std::int32_t y = low.y; y < high.y; ++y) {
      for (std::int32_t z = low.z; z < high.z; ++z) take(Int3{x, y, z});
    }
  }
}

// The finest level of a pyramid, made from the voxels. It is filled unit by unit. A unit is a texel, or a block if
// blocks are larger than texels.
template <class Blocks>
struct FinestLevel {
  const LevelLattice& lattice;
  int level;
  const Blocks& blocks;
  std::vector<float>& texels;

  int unit_level() const { return greater(level, 3); }
  Int3 units() const { return lattice.texels(unit_level()); }

  void fill_unit(const Int3& unit) const {
    Int3 low;
    Int3 high;
    lattice.voxels(unit, unit_level(), low, high);
    if (level < unit_level()) {
      fill_block(unit, blocks_of(low));
    } else {
      fill_texel(unit, low, high);
    }
  }

 private:
  // Fills a texel from the voxels [low, high). They are whole blocks, except at the domain's bounds.
  void fill_texel(const Int3& texel, const Int3& low, const Int3& high) const {
    BlockValues values{};
    VoxelMean mean;
    const Int3 last = blocks_of({high.x - 1, high.y - 1, high.z - 1});
    for_each_in(blocks_of(low), {last.x + 1, last.y + 1, last.z + 1}, [&](const Int3& block) {
      const bool one_value = read(block, values);
      add_block(mean, values, one_value, block, low, high);
    });
    texels[table_index(texel, lattice.texels(level))] = mean.value();
  }

  // Fills the texels of one block, which is a unit: 2^(3 - level) texels along each axis.
  void fill_block(const Int3& unit, const Int3& block) const {
    BlockValues values{};
    const bool one_value = read(block, values);
    const Int3 n = lattice.texels(level);
    const Int3 first = first_texel(unit);
    const std::int32_t edge = 1 << (unit_level() - level);
    const Int3 low{greater(first.x, 0), greater(first.y, 0), greater(first.z, 0)};
    const Int3 high{lesser(first.x + edge, n.x), lesser(first.y + edge, n.y), lesser(first.z + edge, n.z)};
    for_each_in(low, high, [&](const Int3& texel) {
      Int3 begin;
      Int3 end;
      lattice.voxels(texel, level, begin, end);
      VoxelMean mean;
      add_block(mean, values, one_value, block, begin, end);
      texels[table_index(texel, n)] = mean.value();
    });
  }

  // Returns the first texel of a unit, counted from the level's first texel. Texels before that are outside the
  // domain.
  Int3 first_texel(const Int3& unit) const {
    const int parts = unit_level() - level;
    const Int3 first_unit = lattice.first(unit_level());
    const Int3 first = lattice.first(level);
    return {((first_unit.x + unit.x) << parts) - first.x, ((first_unit.y + unit.y) << parts) - first.y,
            ((first_unit.z + unit.z) << parts) - first.z};
  }

  // `block` counts from the first region's corner. The table counts from the domain's first block.
  bool read(const Int3& block, BlockValues& values) const {
    const Int3 corner = blocks_of(lattice.shift);
    return blocks.read({block.x - corner.x, block.y - corner.y, block.z - corner.z}, values);
  }
};

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

template <class Blocks>
void MeanPyramid::fill(const Blocks& blocks, int threads) {
  const int count = level_count(lattice_, first_);
  for (int l = first_; l < first_ + count; ++l) levels_.emplace_back(lattice_.size(l));
  oneapi::tbb::task_arena arena(threads > 0 ? threads : oneapi::tbb::task_arena::automatic);
  arena.execute([&] {
    fill_finest(blocks);
    for (int l = first_ + 1; l < first_ + count; ++l) reduce_level(l);
    for (int l = first_; l < first_ + count; ++l) fill_beside_finite(l);
  });
}

// Splits the work into columns of units in z. A unit is at least one block and at least one texel, so that each block
// is read once.
template <class Blocks>
void MeanPyramid::fill_finest(const Blocks& blocks) {
  const FinestLevel<Blocks> level{lattice_, first_, blocks, levels_.front()};
  const Int3 units = level.units();
  oneapi::tbb::parallel_for(std::int64_t{0}, std::int64_t{units.x} * units.y, [&](std::int64_t column) {
    const auto x = static_cast<std::int32_t>(column % units.x);
    const auto y = static_cast<std::int32_t>(column / units.x);
    for (std::int32_t z = 0; z < units.z; ++z) level.fill_unit({x, y, z});
  });
}

void MeanPyramid::reduce_level(int level) {
  const auto at = static_cast<std::size_t>(level - first_);
  const std::vector<float>& finer = levels_[at - 1];
  std::vector<float>& coarser = levels_[at];
  const Int3 n = lattice_.texels(level);
  oneapi::tbb::parallel_for(0, n.z, [&](std::int32_t z) {
    for (std::int32_t y = 0; y < n.y; ++y) {
      for (std::int32_t x = 0; x < n.x; ++x) {
        coarser[table_index({x, y, z}, n)] = coarser_texel(lattice_, level - 1, finer.data(), {x, y, z});
      }
    }
  });
}

void MeanPyramid::fill_beside_finite(int level) {
  std::vector<float>& texels = levels_[static_cast<std::size_t>(level - first_)];
  const Int3 n = lattice_.texels(level);
  std::vector<std::vector<std::pair<std::size_t, float>>> filled(static_cast<std::size_t>(n.z));  // for each plane
  oneapi::tbb::parallel_for(0, n.z, [&](std::int32_t z) {
    for (std::int32_t y = 0; y < n.y; ++y) {
      for (std::int32_t x = 0; x < n.x; ++x) {
        const std::size_t i = table_index({x, y, z}, n);
        if (is_finite(texels[i])) continue;
        const float value = texel_beside_finite(texels.data(), n, {x, y, z});
        if (is_finite(value)) filled[static_cast<std::size_t>(z)].emplace_back(i, value);
      }
    }
  });
  for (const auto& plane : filled) {
    for (const auto& [i, value] : plane) texels[i] = value;
  }
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
