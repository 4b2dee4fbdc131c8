// The volume that kernels render if its blocks are bricks of a texture. gpu/volume/volume_sampler.h says what a
// tracer asks of a volume.
#pragma once

#include "gpu/cuda/bricks/page_table.h"
#include "gpu/cuda/volume/texture_read.h"
#include "gpu/math/random.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

/// Reads one voxel, or filters trilinearly by the texture unit, with weights of 8 bits. `Table` finds the bricks:
/// position(q) for local voxel coordinates with centres at whole numbers, entry(position) of its block, and
/// texel(entry, position).
template <class Table, Filter kFilter>
struct FilteredBricks {
  using Blocks = Table;

  Table table;
  cudaTextureObject_t texture = 0;

  WEIR_HOST_DEVICE float sample(const Float3& p, [[maybe_unused]] Random& random) const {
    if constexpr (kFilter == Filter::stochastic) {
      // Picks one of the eight voxels around p with the probability of its weight: the voxel that covers p after p
      // moves by up to half a voxel.
      const Float3 moved{p.x - 0.5F + random.uniform(), p.y - 0.5F + random.uniform(), p.z - 0.5F + random.uniform()};
      return look_up({std::floor(moved.x), std::floor(moved.y), std::floor(moved.z)});
    } else {
      return smooth(p);
    }
  }

  /// Only for a table that may miss entries.
  WEIR_HOST_DEVICE static bool missed() requires requires { Table::missed(); }
  { return Table::missed(); }
  WEIR_HOST_DEVICE static void set_missed(bool missed) requires requires { Table::missed(); }
  { Table::set_missed(missed); }

  WEIR_HOST_DEVICE float smooth(const Float3& p) const {
    if constexpr (kFilter == Filter::nearest) return look_up({std::floor(p.x), std::floor(p.y), std::floor(p.z)});
    return look_up({p.x - 0.5F, p.y - 0.5F, p.z - 0.5F});
  }

 private:
  WEIR_HOST_DEVICE float look_up(const Float3& q) const {
    const auto at = table.position(q);
    const BrickEntry entry = table.entry(at);
    if (entry.brick == 0) return entry.low;
    return entry.low + entry.span * read_texture(texture, Table::texel(entry, at));
  }
};

}  // namespace weir
