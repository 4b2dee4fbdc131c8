// Makes levels of detail of a source's blocks. `Machine` is as for BrickPager.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/cuda/bricks/block_source.h"
#include "gpu/cuda/bricks/level_steps.h"
#include "gpu/cuda/bricks/page_table.h"

namespace weir {

/// Bytes of a decoded region: its blocks' values and ids.
inline constexpr std::uint64_t kDecodedRegionBytes = kRegionBlocks * (512 * sizeof(float) + sizeof(BlockId));

/// Makes the finest level. Decodes as many regions together as `scratch` bytes hold, at least one. `regions` are
/// source.regions().
template <class Machine>
typename Machine::template Array<float> finest_level_of(const Machine& machine, BlockSource& source,
                                                        std::span<const RegionEntry> regions,
                                                        const LevelLattice& levels, int level, std::uint64_t scratch) {
  constexpr std::size_t kMostTogether = 32;  // enough to keep a device busy
  using Numbers = typename Machine::template Array<std::uint32_t>;
  using Floats = typename Machine::template Array<float>;
  const BlockLattice lattice = source.lattice();
  Floats texels(levels.size(level));
  std::vector<std::uint32_t> plain;
  std::vector<float> values;
  std::vector<std::uint32_t> coded;
  for (std::uint32_t r = 0; r < regions.size(); ++r) {
    if ((regions[r].page & RegionEntry::kMissing) != 0) {
      coded.push_back(r);
    } else {
      plain.push_back(r);
      values.push_back(regions[r].value);
    }
  }
  const std::uint32_t count = RegionTexels::count(level);
  const auto in_batches = [](std::size_t size, std::size_t most, const auto& work) {
    for (std::size_t first = 0; first < size; first += most) work(first, std::min(most, size - first));
  };

  if (!plain.empty()) {
    constexpr std::size_t kPlainTogether = 1024;
    Numbers listed(plain.size());
    Floats listed_values(values.size());
    listed.upload(plain);
    listed_values.upload(values);
    in_batches(plain.size(), kPlainTogether, [&](std::size_t first, std::size_t some) {
      machine.each(static_cast<std::uint32_t>(some) * count,
                   FillFinestPlain{
                       {lattice, levels, level, listed.data() + first}, listed_values.data() + first, texels.data()});
    });
    machine.wait();
  }
  if (!coded.empty()) {
    const std::size_t together =
        std::clamp<std::size_t>(scratch / kDecodedRegionBytes, 1, std::min(kMostTogether, coded.size()));
    Numbers listed(coded.size());
    listed.upload(coded);
    typename Machine::template Array<BlockId> blocks(together * kRegionBlocks);
    Floats decoded(together * kRegionBlocks * 512);
    in_batches(coded.size(), together, [&](std::size_t first, std::size_t some) {
      const auto size = static_cast<std::uint32_t>(some * kRegionBlocks);
      machine.each(size, ListRegionBlocks{lattice, listed.data() + first, blocks.data()});
      source.decode(blocks.data(), size, decoded.data());
      machine.each(static_cast<std::uint32_t>(some) * count,
                   FillFinest{{lattice, levels, level, listed.data() + first}, decoded.data(), texels.data()});
    });
    source.check();
  }
  return texels;
}

/// Makes level `level` + 1 from level `level`.
template <class Machine>
typename Machine::template Array<float> coarser_level_of(const Machine& machine, const LevelLattice& levels, int level,
                                                         const float* finer) {
  typename Machine::template Array<float> texels(levels.size(level + 1));
  machine.each(static_cast<std::uint32_t>(texels.size()), FillCoarser{levels, level, finer, texels.data()});
  return texels;
}

/// Writes the `size` texels of a level to `out` as look-ups read them (texel_beside_finite).
template <class Machine, class Out>
void write_level(const Machine& machine, const Int3& size, const float* texels, const Out& out) {
  constexpr std::uint32_t kMostTogether = std::uint32_t{1} << 30U;  // a large level has more texels than a step counts
  const std::uint32_t plane = static_cast<std::uint32_t>(size.x) * static_cast<std::uint32_t>(size.y);
  const auto planes = static_cast<std::int32_t>(std::max(kMostTogether / plane, std::uint32_t{1}));
  for (std::int32_t z = 0; z < size.z; z += planes) {
    const auto some = static_cast<std::uint32_t>(std::min(planes, size.z - z));
    machine.each(plane * some, WritePlanes<Out>{size, texels, z, out});
  }
}

}  // namespace weir
