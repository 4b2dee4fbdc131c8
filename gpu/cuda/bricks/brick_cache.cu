#include "gpu/cuda/bricks/brick_cache.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <span>
#include <utility>

#include "format/base/error.h"
#include "format/base/message.h"
#include "format/base/text.h"
#include "gpu/cuda/bricks/brick_pager.h"
#include "gpu/cuda/bricks/brick_texels.h"
#include "gpu/cuda/bricks/device_machine.cuh"
#include "gpu/cuda/volume/device_memory.h"

namespace weir {

namespace {

constexpr std::uint64_t kPageBytes = kRegionBlocks * sizeof(BrickEntry);
constexpr std::uint64_t kSlotBytes = 3 * sizeof(std::uint32_t) + sizeof(float);
// Bytes of a block that is decoded with others: its values, and its share of the table of numbers.
constexpr std::uint64_t kBlockBytes = 512 * sizeof(float) + 8 * sizeof(BlockId) + 32 * 12;
constexpr std::uint32_t kMostBlocks = 1U << 17U;  // most blocks decoded together: enough to keep a device busy
constexpr std::uint32_t kLeastBlocks = 1U << 10U;
constexpr std::uint64_t kSmallCache = std::uint64_t{128} << 20U;  // below it, room for bricks matters more than time
constexpr std::uint32_t kMostRequests = 1U << 20U;
constexpr std::uint32_t kLeastSlots = 1U << 12U;  // some tens for each ray of a tile

template <class Texel>
using DevicePager = BrickPager<DeviceMachine, SurfaceTexels<Texel>>;

}  // namespace

/// A pager of either kind of texels.
class BrickCache::Pager {
 public:
  Pager(TexelType type, BlockSource& source, std::span<const RegionEntry> regions, const BrickPlan& plan,
        cudaSurfaceObject_t surface) {
    if (type == TexelType::share16) {
      words_.emplace(DeviceMachine{}, source, regions, plan, SurfaceTexels<unsigned short>{surface});
    } else {
      floats_.emplace(DeviceMachine{}, source, regions, plan, SurfaceTexels<float>{surface});
    }
  }

  template <class Use>
  decltype(auto) with(const Use& use) {
    return words_ ? use(*words_) : use(*floats_);
  }

 private:
  std::optional<DevicePager<unsigned short>> words_;
  std::optional<DevicePager<float>> floats_;
};

BrickCache::BrickCache(std::unique_ptr<BlockSource> source, const BrickBudget& budget, BricksKept kept)
    : source_(std::move(source)),
      regions_(source_->regions()),
      budget_(budget),
      left_(budget.bytes > budget.taken + budget.levels ? budget.bytes - budget.taken - budget.levels : 0),
      kept_(kept) {
  make(TexelType::share16);
}

BrickCache::~BrickCache() = default;

// Throws if a failure has left no pager.
BrickCache::Pager& BrickCache::pager() const {
  if (!pager_) throw Error(ErrorKind::internal, "a cache of bricks is used that is to be restored first");
  return *pager_;
}

PageTable BrickCache::pages() {
  return pager().with([](auto& pager) { return pager.table(); });
}

// Returns what a cache needs that holds only some of the bricks at a time. A turn of decoding takes nearly as long
// for few blocks as for many.
BrickCache::Needs BrickCache::needs() const { return needs(left_ < kSmallCache ? left_ / 8 : left_ / 4); }

BrickCache::Needs BrickCache::needs(std::uint64_t decoding) const {
  Needs needs;
  needs.table = regions_.size() * (sizeof(RegionEntry) + sizeof(std::uint32_t));
  const std::uint64_t scratch =
      std::clamp<std::uint64_t>(decoding, kLeastBlocks * kBlockBytes, kMostBlocks * kBlockBytes);
  needs.plan.blocks = static_cast<std::uint32_t>(scratch / kBlockBytes);
  // As many as there may be slots. If a full list leaves something out, the picture is drawn once more.
  needs.plan.most_requests = static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(left_ / brick_bytes(TexelType::share16), kRegionBlocks, kMostRequests));
  needs.fixed = needs.table + scratch + needs.plan.most_requests * sizeof(BlockId);
  return needs;
}

void BrickCache::clear() {
  pager_.reset();
  whole_ = DeviceArray<BrickEntry>();
  texture_ = Texture();
  slots_ = 0;
}

void BrickCache::restore() {
  if (!pager_) make(type_);
}

bool BrickCache::shrink(std::uint64_t bytes, const std::string& why) {
  const std::uint64_t held = pager_ ? std::min(left_, this->bytes()) : left_;
  const std::uint64_t given = std::max(bytes, held / 8);
  if (kept_ == BricksKept::all || held <= given) return false;
  const std::uint64_t before = std::exchange(left_, held - given);
  if (!needs().fit(type_, left_)) {
    left_ = before;
    return false;
  }
  refusal_ = why;
  make(type_);
  return true;
}

// Tries with less and less of the budget while the device refuses memory, because other programs use the device too.
void BrickCache::make(TexelType type) {
  const std::uint64_t before = left_;
  const std::string refused_before = refusal_;
  for (;;) {
    try {
      return make_within(type);
    } catch (const DeviceFull& full) {
      clear();
      const std::uint64_t free = free_device_bytes(~std::uint64_t{0});
      refusal_ = full.what();
      left_ = std::min(left_ - left_ / 4, free);
      if (kept_ == BricksKept::some && needs().fit(type, left_)) continue;
      left_ = before;  // there may be room at another time
      refusal_ = refused_before;
      throw;
    } catch (...) {
      clear();
      throw;
    }
  }
}

void BrickCache::make_within(TexelType type) {
  type_ = type;
  clear();
  if (make_whole()) return;
  if (kept_ == BricksKept::all) {
    throw Error(ErrorKind::io, cat("all bricks of the grid do not fit into the ", format_bytes(left_),
                                   " of device memory left for them, or into a texture"));
  }
  make_paged();
}

void BrickCache::make_pager(BrickPlan plan, const TextureShape& shape) {
  texture_ = Texture(shape.texels(), type_);
  slots_ = plan.slots;
  plan.across = shape.x;
  plan.down = shape.y;
  pager_ = std::make_unique<Pager>(type_, *source_, regions_, plan, texture_.surface());
}

// Makes a cache of all bricks. Returns false if they do not fit.
bool BrickCache::make_whole() {
  Needs needs = this->needs(left_ / 8);
  const BlockLattice lattice = source_->lattice();
  const auto most = static_cast<std::int32_t>(kFixedPointEnd - 8);
  if (greater(lattice.extent.x, greater(lattice.extent.y, lattice.extent.z)) > most) return false;
  if (regions_.size() >= 1U << 20U) return false;  // entries are counted in 32 bits
  needs.plan.pages = static_cast<std::uint32_t>(regions_.size());
  needs.fixed += 2 * (regions_.size() + 1) * kPageBytes;  // pages, and the table made from them
  if (needs.fixed > left_ / 2) return false;
  needs.plan.slots = 1;
  pager_ = std::make_unique<Pager>(type_, *source_, regions_, needs.plan, 0);
  const std::uint32_t missing = pager_->with([](auto& pager) { return pager.bring_all_pages(); });
  pager_.reset();
  const TextureShape shape = shape_for(std::uint64_t{missing} + 1);
  if (shape.size() <= missing || needs.fixed + missing * kSlotBytes + shape.size() * brick_bytes(type_) > left_) {
    return false;
  }
  needs.plan.slots = std::max(1U, missing);
  make_pager(needs.plan, shape);
  paged_ = false;
  const bool fits = pager_->with([&](auto& pager) {
    pager.bring_all_pages();
    if (!pager.bring_all_bricks()) return false;
    whole_ = pager.take_table();
    return true;
  });
  if (!fits) make_within(TexelType::float32);
  return true;
}

void BrickCache::fail_too_small(const Needs& needs) const {
  // Enough for floats as well, and for the eighth or quarter that decoding takes.
  const std::uint64_t most = needs.least(TexelType::float32);
  const std::uint64_t decoding = most < kSmallCache / 2 ? most / 5 : most / 2;
  std::uint64_t enough = std::max(20 * needs.table, most + decoding) + budget_.taken;
  if (budget_.levels > 0) enough += bytes_for_levels(2 * enough);
  const auto megabytes = [](std::uint64_t bytes) { return cat((bytes >> 20U) + 1, "MiB"); };
  if (!budget_.limited) {
    throw Error(ErrorKind::input,
                compose("the grid takes ", megabytes(enough), " of device memory at least, where ",
                        format_bytes(budget_.bytes), " may be used; render it with ", option("backend", "cpu")));
  }
  const std::string series =
      budget_.volumes > 1 ? cat(", ", budget_.volumes, " volumes of a series being held at a time") : std::string();
  throw Error(ErrorKind::usage, compose(option("device-memory", format_bytes(budget_.volumes * budget_.bytes)),
                                        " is too small for this grid", series, "; give ",
                                        option("device-memory", megabytes(budget_.volumes * enough)), " or more"));
}

std::uint64_t BrickCache::Needs::least(TexelType type) const {
  return fixed + 20 * kPageBytes + 2 * kLeastSlots * (brick_bytes(type) + kSlotBytes);
}

bool BrickCache::Needs::fit(TexelType type, std::uint64_t bytes) const {
  return table <= bytes / 20 && least(type) <= bytes;
}

// Makes a cache with places for as many bricks as fit.
void BrickCache::make_paged() {
  Needs needs = this->needs();
  if (!needs.fit(type_, left_)) {
    if (!refusal_.empty()) throw DeviceFull(refusal_, 0);  // more was asked for than there was
    fail_too_small(needs);
  }
  const auto missing = std::ranges::count_if(
      regions_, [](const RegionEntry& region) { return (region.page & RegionEntry::kMissing) != 0; });
  needs.plan.pages = static_cast<std::uint32_t>(
      std::min<std::uint64_t>(std::max<std::uint64_t>(1, static_cast<std::uint64_t>(missing)),
                              std::max<std::uint64_t>(left_ / 10, kPageBytes) / kPageBytes));
  const std::uint64_t rest = left_ - needs.fixed - (std::uint64_t{needs.plan.pages} + 1) * kPageBytes;
  const TextureShape shape = shape_within(rest * brick_bytes(type_) / (brick_bytes(type_) + kSlotBytes), type_);
  needs.plan.slots = static_cast<std::uint32_t>(shape.size() - 1);
  make_pager(needs.plan, shape);
  paged_ = true;
}

std::uint64_t BrickCache::bytes() const {
  return texture_.bytes() + whole_.bytes() + pager().with([](auto& pager) { return pager.bytes(); });
}

BrickCounters BrickCache::counters() const {
  return pager().with([](auto& pager) { return pager.counters(); });
}

PagingTurn BrickCache::serve() {
  PagingTurn turn;
  try {
    turn = pager().with([](auto& pager) { return pager.serve(); });
  } catch (...) {
    clear();  // it is unknown what was brought in
    throw;
  }
  if (turn.unfit) make(TexelType::float32);
  return turn;
}

void BrickCache::check() {
  pager().with([](auto& pager) { pager.check(); });
}

std::string BrickCache::texels_note() const {
  if (type_ == TexelType::float32) return "float texels";
  const float span = std::bit_cast<float>(counters().worst);
  return cat("16-bit texels, off by at most ", span / (2 * kMostTexel));
}

}  // namespace weir
