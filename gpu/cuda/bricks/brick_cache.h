// The blocks of a grid as bricks of a texture on the current device, which filters them: all of them where there is
// room, else as many as fit, brought in when they are looked up.
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

/// What a cache may leave out.
enum class BricksKept {
  some,  ///< those that were not looked up, where there is no room for all
  all,   ///< none: where there is no room, making it is an error
};

/// What a cache may take of a device.
struct BrickBudget {
  std::uint64_t bytes = 0;    ///< with what its source reads
  std::uint64_t taken = 0;    ///< by that already
  std::uint64_t levels = 0;   ///< of them kept for levels of detail
  std::uint64_t volumes = 1;  ///< that are held at a time, each with as much
  bool limited = true;        ///< by --device-memory; otherwise by what is free
};

/// What to keep of a budget of `bytes` for levels of detail: an eighth, or what small grids need.
constexpr std::uint64_t bytes_for_levels(std::uint64_t bytes) {
  constexpr std::uint64_t kSmall = std::uint64_t{24} << 20U;
  return std::max(bytes / 8, std::min(bytes / 4, kSmall));
}

/// Made and used with its device current, by one thread at a time.
class BrickCache {
 public:
  /// Texels have 16 bits, in a range of each brick's own, floats where that does not hold a brick's values (some not
  /// finite). Where the device has less room than the budget, a cache of `some` bricks is smaller. Throws Error(usage)
  /// where the budget is too small, with what would do, DeviceFull where the device has no room for the smallest cache
  /// (or for all bricks), Error(input) where blocks are damaged.
  BrickCache(std::unique_ptr<BlockSource> source, const BrickBudget& budget, BricksKept kept = BricksKept::some);
  ~BrickCache();

  /// Makes it once more where a failure of serve() or shrink() has left nothing; to be called before a picture. Throws
  /// as the constructor.
  void restore();
  /// Gives `bytes` back to the device for something else that it has refused for the reason `why`, and an eighth of
  /// the cache at least; its bricks are to be brought in again. False, and nothing has changed, where a cache that much
  /// smaller would hold too little, or holds all or nothing. Throws as the constructor.
  bool shrink(std::uint64_t bytes, const std::string& why);
  /// Why it is smaller than its budget: what the device has refused; empty: it is not.
  const std::string& refusal() const { return refusal_; }

  /// Whether bricks come and go: there are fewer places than bricks, or an axis is too long for a BrickTable.
  bool paged() const { return paged_; }
  TexelType texel_type() const { return type_; }   ///< for tests
  std::uint64_t bytes() const;                     ///< of device memory
  std::uint64_t bricks() const { return slots_; }  ///< there is room for
  BrickCounters counters() const;                  ///< as of the last turn

  BlockSource& source() const { return *source_; }
  /// source().regions().
  const std::vector<RegionEntry>& regions() const { return regions_; }

  /// Of one that is not paged.
  template <Filter kFilter>
  BrickSampler<kFilter> sampler() const {
    return {BrickTable(source_->lattice(), whole_.data()), texture_.object()};
  }
  /// Of a paged one: calls use(PagedSampler) with one that reaches all of the domain.
  template <Filter kFilter, Noting kNoting, class Use>
  decltype(auto) with_paged_sampler(const Use& use) {
    const Int3& extent = source_->lattice().extent;
    const bool wide = greater(extent.x, greater(extent.y, extent.z)) > FixedPositions::kMost;
    if (wide) return use(paged_sampler<PagedSampler<kFilter, kNoting, WidePositions>>());
    return use(paged_sampler<PagedSampler<kFilter, kNoting>>());
  }
  /// The same where it is known which. Only until serve() finds something unfit.
  template <class Sampler>
  Sampler paged_sampler() {
    return {{pages(), decltype(Sampler::table.positions)(source_->lattice())}, texture_.object()};
  }

  /// Of a paged one: brings in what was looked up and missing since the last call. Where that was `unfit`, all that was
  /// drawn is to be drawn again, from floats. Throws as the constructor; the cache is gone then, until restore().
  PagingTurn serve();
  /// Throws Error(input) where a block that was decoded is damaged.
  void check();
  /// "16-bit texels, off by at most 1.5e-05": of all bricks so far.
  std::string texels_note() const;

 private:
  class Pager;

  struct Needs {
    BrickPlan plan;           // without pages, slots and their shape
    std::uint64_t table = 0;  // bytes of the regions'
    std::uint64_t fixed = 0;  // bytes of that, and of all that brings bricks in

    std::uint64_t least(TexelType type) const;            // bytes of the smallest cache
    bool fit(TexelType type, std::uint64_t bytes) const;  // a cache of so many
  };

  Pager& pager() const;
  PageTable pages();
  Needs needs() const;
  /// With `decoding` bytes, about, for blocks that are decoded together.
  Needs needs(std::uint64_t decoding) const;
  void clear();
  void make(TexelType type);
  void make_within(TexelType type);
  bool make_whole();
  void make_paged();
  [[noreturn]] void fail_too_small(const Needs& needs) const;
  void make_pager(BrickPlan plan, const TextureShape& shape);

  std::unique_ptr<BlockSource> source_;
  std::vector<RegionEntry> regions_;  // as the source has them
  BrickBudget budget_;
  std::uint64_t left_;  // bytes of it
  std::string refusal_;
  BricksKept kept_;
  TexelType type_ = TexelType::share16;
  bool paged_ = false;
  std::uint32_t slots_ = 0;
  Texture texture_;
  std::unique_ptr<Pager> pager_;
  DeviceArray<BrickEntry> whole_;  // of all blocks, where all are there
};

}  // namespace weir
