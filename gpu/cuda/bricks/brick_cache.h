// The blocks of a grid as bricks of a texture on the current device, which filters them. The cache holds all bricks
// if there is room, otherwise as many as fit, and brings bricks in when they are looked up.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gpu/cuda/bricks/block_source.h"
#include "gpu/cuda/bricks/brick_counters.h"
#include "gpu/cuda/bricks/brick_plan.h"
#include "gpu/cuda/bricks/brick_sampler.h"
#include "gpu/cuda/bricks/paged_sampler.h"
#include "gpu/cuda/bricks/paging_turn.h"
#include "gpu/cuda/bricks/texture_shape.h"
#include "gpu/cuda/runtime/device_array.h"
#include "gpu/cuda/volume/texture.h"

namespace weir {

/// Which bricks a cache must hold.
enum class BricksKept {
  some,  ///< only those that were looked up, if there is no room for all
  all,   ///< all bricks; if there is no room, making the cache is an error
};

/// How much device memory a cache may take.
struct BrickBudget {
  std::uint64_t bytes = 0;    ///< including what the cache's source reads
  std::uint64_t taken = 0;    ///< part of `bytes` that the source has taken already
  std::uint64_t levels = 0;   ///< part of `bytes` kept for levels of detail
  std::uint64_t volumes = 1;  ///< volumes held at a time, each with the same budget
  bool limited = true;        ///< true: limited by --device-memory; false: by the free memory
};

/// Returns how much of a budget of `bytes` to keep for levels of detail: an eighth, or what small grids need.
constexpr std::uint64_t bytes_for_levels(std::uint64_t bytes) {
  constexpr std::uint64_t kSmall = std::uint64_t{24} << 20U;
  return std::max(bytes / 8, std::min(bytes / 4, kSmall));
}

/// Must be made and used with its device current, by one thread at a time.
class BrickCache {
 public:
  /// Texels have 16 bits, scaled to each brick's own range. They are floats if 16 bits do not hold a brick's values
  /// (for example, some are not finite). If the device has less room than the budget, a cache of `some` bricks is
  /// made smaller. Throws Error(usage) if a limited budget is too small, naming a sufficient one, and Error(input) if
  /// the free memory is. Throws DeviceFull if the device has no room for the smallest cache (or for all bricks),
  /// Error(io) if all bricks do not fit the budget or a texture, Error(input) if blocks are damaged.
  BrickCache(std::unique_ptr<BlockSource> source, const BrickBudget& budget, BricksKept kept = BricksKept::some);
  ~BrickCache();

  /// Makes the cache again if a failure of serve() or shrink() has left none. Call it before each picture. Throws the
  /// errors of the constructor.
  void restore();
  /// Gives `bytes`, and at least an eighth of the cache, back to the device for another allocation, which it refused
  /// for the reason `why`. The bricks must be brought in again. Returns false and changes nothing if the smaller
  /// cache would hold too little, or if the cache must hold all bricks. Throws the errors of the constructor.
  bool shrink(std::uint64_t bytes, const std::string& why);
  /// Returns why the cache is smaller than its budget: what the device has refused. Empty if it is not smaller.
  const std::string& refusal() const { return refusal_; }

  /// Returns whether bricks come and go, because there are fewer places than bricks or an axis is too long for a
  /// BrickTable.
  bool paged() const { return paged_; }
  TexelType texel_type() const { return type_; }   ///< for tests
  std::uint64_t bytes() const;                     ///< bytes of device memory
  std::uint64_t bricks() const { return slots_; }  ///< bricks that there is room for
  BrickCounters counters() const;                  ///< as of the last turn

  BlockSource& source() const { return *source_; }
  /// Returns source().regions().
  const std::vector<RegionEntry>& regions() const { return regions_; }

  /// For a cache that is not paged.
  template <Filter kFilter>
  BrickSampler<kFilter> sampler() const {
    return {BrickTable(source_->lattice(), whole_.data()), texture_.object()};
  }
  /// For a paged cache: calls use(sampler) with a PagedSampler that reaches all of the domain.
  template <Filter kFilter, Noting kNoting, class Use>
  decltype(auto) with_paged_sampler(const Use& use) {
    const Int3& extent = source_->lattice().extent;
    const bool wide = greater(extent.x, greater(extent.y, extent.z)) > FixedPositions::kMost;
    if (wide) return use(paged_sampler<PagedSampler<kFilter, kNoting, WidePositions>>());
    return use(paged_sampler<PagedSampler<kFilter, kNoting>>());
  }
  /// Returns the sampler if its type is known. It is valid until serve() finds a brick unfit.
  template <class Sampler>
  Sampler paged_sampler() {
    return {{pages(), decltype(Sampler::table.positions)(source_->lattice())}, texture_.object()};
  }

  /// For a paged cache: brings in what was looked up and missing since the last call. If the result is `unfit`,
  /// everything drawn must be drawn again, from floats. Throws the errors of the constructor; then the cache is gone
  /// until restore().
  PagingTurn serve();
  /// Throws Error(input) if a decoded block is damaged.
  void check();
  /// Returns, for example, "16-bit texels, off by at most 1.5e-05", for all bricks so far.
  std::string texels_note() const;

 private:
  class Pager;

  struct Needs {
    BrickPlan plan;           // without pages, slots and the texture's shape
    std::uint64_t table = 0;  // bytes of the regions' entries
    std::uint64_t fixed = 0;  // bytes of `table` and of all that brings bricks in

    std::uint64_t least(TexelType type) const;            // bytes of the smallest cache
    bool fit(TexelType type, std::uint64_t bytes) const;  // whether a cache of `bytes` is large enough
  };

  Pager& pager() const;
  PageTable pages();
  Needs needs() const;
  /// `decoding`: about how many bytes are for blocks that are decoded together.
  Needs needs(std::uint64_t decoding) const;
  void clear();
  void make(TexelType type);
  void make_within(TexelType type);
  bool make_whole();
  void make_paged();
  [[noreturn]] void fail_too_small(const Needs& needs) const;
  void make_pager(BrickPlan plan, const TextureShape& shape);

  std::unique_ptr<BlockSource> source_;
  std::vector<RegionEntry> regions_;  // source_->regions()
  BrickBudget budget_;
  std::uint64_t left_;  // bytes of the budget that are left
  std::string refusal_;
  BricksKept kept_;
  TexelType type_ = TexelType::share16;
  bool paged_ = false;
  std::uint32_t slots_ = 0;
  Texture texture_;
  std::unique_ptr<Pager> pager_;
  DeviceArray<BrickEntry> whole_;  // entries of all blocks, if all bricks are on the device
};

}  // namespace weir
