// A brick cache on the host, over a packed grid of many kinds of blocks, for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"
#include "gpu/cuda/bricks/brick_pager.h"
#include "gpu/volume/leaf_table.h"
#include "tests/gpu/bricks/host_machine.h"
#include "tests/support/packed_kinds.h"

namespace weir::test {

template <class Texel>
struct Cache {
  using Texels = HostTexels<Texel>;

  Cache(const NvdbGrid& grid, BrickPlan plan)
      : source(*grid.packed(), grid.index_bbox()),
        size{static_cast<std::int32_t>(plan.across) * kBrickEdge, static_cast<std::int32_t>(plan.down) * kBrickEdge,
             (static_cast<std::int32_t>(plan.slots / (plan.across * plan.down)) + 1) * kBrickEdge},
        memory(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z)),
        texels{&memory, size},
        pager({}, source, source.regions(), plan, texels) {}

  // Returns the texel of the block's brick that is `v` from its corner.
  float texel(const BrickEntry& entry, const Int3& v) const {
    if (entry.brick == 0) return entry.low;
    const Int3 corner = entry.corner();
    return entry.low + entry.span * texels.read({corner.x + v.x, corner.y + v.y, corner.z + v.z});
  }

  HostPackedSource source;
  Int3 size;
  std::vector<Texel> memory;
  Texels texels;
  BrickPager<HostMachine, Texels> pager;
};

class BrickPagerTest : public testing::Test {
 protected:
  BrickPagerTest() { open(build_packed_kinds()); }

  void open(PackedFile file) {
    file_ = std::move(file);
    grid_ = std::make_unique<NvdbGrid>(NvdbGrid::open(file_.file, "a.nvdb"));
    leaves_ = std::make_unique<LeafTable>(*grid_);
    lattice_ = block_lattice(grid_->index_bbox());
  }

  static BrickPlan plan(std::uint32_t pages, std::uint32_t slots) {
    return {.pages = pages, .slots = slots, .across = 5, .down = 7, .blocks = 200, .most_requests = 8192};
  }

  // Returns the value of the voxel that is `v` from the first region's corner, or of the domain's nearest voxel.
  float voxel(const Int3& v) const {
    const auto local = [](std::int32_t at, std::int32_t shift, std::int32_t extent) {
      return std::clamp(at - shift, 0, extent - 1);
    };
    return leaves_->view().voxel({local(v.x, lattice_.shift.x, lattice_.extent.x),
                                  local(v.y, lattice_.shift.y, lattice_.extent.y),
                                  local(v.z, lattice_.shift.z, lattice_.extent.z)});
  }

  template <class Visit>
  void for_each_block(const Visit& visit) const {
    const Int3 last = lattice_.last_block();
    for (std::int32_t x = lattice_.shift.x >> 3; x <= last.x; ++x) {
      for (std::int32_t y = lattice_.shift.y >> 3; y <= last.y; ++y) {
        for (std::int32_t z = lattice_.shift.z >> 3; z <= last.z; ++z) visit(Int3{x, y, z});
      }
    }
  }

  // Returns the largest difference between the block's texels and the voxels, in spans of its brick.
  template <class Texel>
  double difference(const Cache<Texel>& cache, const BrickEntry& entry, const Int3& block) const {
    double most = 0;
    for (std::int32_t x = 0; x < kBrickEdge; ++x) {
      for (std::int32_t y = 0; y < kBrickEdge; ++y) {
        for (std::int32_t z = 0; z < kBrickEdge; ++z) {
          const float expected = voxel({8 * block.x + x, 8 * block.y + y, 8 * block.z + z});
          const float found = cache.texel(entry, {x, y, z});
          if (expected == found) continue;
          most = std::max(most, std::abs(static_cast<double>(expected) - found) / entry.span);
        }
      }
    }
    return most;
  }

  PackedFile file_;
  std::unique_ptr<NvdbGrid> grid_;
  std::unique_ptr<LeafTable> leaves_;
  BlockLattice lattice_;
};

// Looks up all of `blocks`, as a picture does. Returns how many were there; all of these have the right voxels.
template <class C, class Test>
std::size_t look_up(C& cache, const Test& test, const std::vector<Int3>& blocks) {
  std::size_t found = 0;
  for (const Int3& block : blocks) {
    const BrickEntry entry = cache.pager.table().find_or_request(block);
    if ((entry.state & brick_state::kMissing) != 0) continue;
    test(entry, block);
    ++found;
  }
  return found;
}

}  // namespace weir::test
