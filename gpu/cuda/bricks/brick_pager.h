// The turns of a brick cache. After a picture's look-ups have noted what they miss, a turn brings pages and bricks in
// and evicts the least recently used ones if there is no room. `Machine` provides the memory and runs the work: a
// device (device_machine.cuh), or the host in tests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "gpu/cuda/bricks/block_source.h"
#include "gpu/cuda/bricks/brick_build.h"
#include "gpu/cuda/bricks/brick_plan.h"
#include "gpu/cuda/bricks/brick_slots.h"
#include "gpu/cuda/bricks/brick_table.h"
#include "gpu/cuda/bricks/page_steps.h"
#include "gpu/cuda/bricks/page_table.h"
#include "gpu/cuda/bricks/paging_turn.h"

namespace weir {

template <class Machine, class Texels>
class BrickPager {
  template <class T>
  using Array = typename Machine::template Array<T>;

 public:
  /// `source` must outlive the object; `regions` are its regions().
  BrickPager(Machine machine, BlockSource& source, std::span<const RegionEntry> regions, const BrickPlan& plan,
             const Texels& texels)
      : machine_(machine),
        source_(source),
        plan_(plan),
        texels_(texels),
        regions_(regions.size()),
        entries_(std::size_t{kRegionBlocks} * (plan.pages + 1)),
        page_stamps_(plan.pages + 1),
        page_regions_(plan.pages + 1, kNoRegion),
        owners_(plan.slots),
        stamps_(plan.slots),
        free_(plan.slots),
        middles_(plan.slots),
        counters_(1),
        bricks_(plan.most_requests),
        wanted_regions_(plan.pages),
        listed_regions_(plan.pages),
        listed_pages_(plan.pages),
        keys_(number_slots(plan)),
        numbers_(number_slots(plan)),
        blocks_(std::size_t{8} * plan.blocks),
        values_(std::size_t{512} * plan.blocks),
        batch_(std::max(1U, plan.blocks / 2)) {
    regions_.upload(regions);
    machine_.clear(page_stamps_);
    free_pages_.resize(plan.pages);
    std::iota(free_pages_.rbegin(), free_pages_.rend(), 1U);
    BrickCounters counters;
    counters.free_slots = plan.slots;
    counters_.upload(std::span(&counters, 1));
    machine_.each(plan.slots, FreeAllSlots{slots()});
    machine_.wait();  // another thread may use the object next
  }

  PageTable table() {
    BrickCounters* counters = counters_.data();
    return {.lattice = source_.lattice(),
            .regions = regions_.data(),
            .entries = entries_.data(),
            .requests = {bricks_.data(), wanted_regions_.data(), &counters->brick_requests, &counters->region_requests,
                         plan_.most_requests, plan_.pages}};
  }

  /// Returns the bytes of this object's memory, without the texels.
  std::uint64_t bytes() const {
    return regions_.bytes() + entries_.bytes() + page_stamps_.bytes() + owners_.bytes() + stamps_.bytes() +
           free_.bytes() + middles_.bytes() + counters_.bytes() + bricks_.bytes() + wanted_regions_.bytes() +
           listed_regions_.bytes() + listed_pages_.bytes() + keys_.bytes() + numbers_.bytes() + blocks_.bytes() +
           values_.bytes();
  }
  /// Returns the counters as of the last turn.
  const BrickCounters& counters() const { return seen_; }

  /// Brings in a page for each region, for which the plan has enough pages. Returns how many bricks are missing then.
  std::uint32_t bring_all_pages() {
    std::vector<std::uint32_t> regions(regions_.size());
    std::iota(regions.begin(), regions.end(), 0U);
    fill_pages(regions);
    Array<std::uint32_t> count(1);
    machine_.clear(count);
    machine_.each(kRegionBlocks * static_cast<std::uint32_t>(regions.size()),
                  CountMissing{entries_.data(), count.data()});
    std::uint32_t missing = 0;
    count.download(std::span(&missing, 1));
    return missing;
  }

  /// Brings in all bricks after all pages; the plan has slots for them. Returns false if 16 bits do not hold some
  /// brick.
  bool bring_all_bricks() {
    const std::uint32_t pages = plan_.pages - static_cast<std::uint32_t>(free_pages_.size());
    const std::uint32_t at_once = std::max(1U, plan_.most_requests / kRegionBlocks);
    listed_regions_.upload(std::span<const std::uint32_t>(page_regions_).subspan(1, pages));
    for (std::uint32_t first = 1; first <= pages; first += at_once) {
      const std::uint32_t some = std::min(at_once, pages + 1 - first);
      machine_.each(kRegionBlocks * some, RequestMissing{table(), first, listed_regions_.data()});
      read_counters();
      build(std::min(seen_.brick_requests, plan_.most_requests));
      machine_.each(1, EndTurn{counters_.data()});
    }
    check();
    return seen_.unfit == 0;
  }

  /// Serves what look-ups have requested since the last turn.
  PagingTurn serve() {
    ++turn_;
    const std::uint32_t groups = std::clamp(plan_.slots / 4096U, 1U, 1024U);
    machine_.each(1, BeginTurn{counters_.data()});
    machine_.groups(groups, AgeSlots{slots(), entries_.data(), page_stamps_.data(), counters_.data(), turn_, groups});
    read_counters();
    PagingTurn turn;
    turn.unfit = seen_.unfit > 0;
    turn.asked_pages = std::min(seen_.region_requests, plan_.pages);
    turn.asked_bricks = std::min(seen_.brick_requests, plan_.most_requests);
    evicted_ = 0;
    turn.pages = serve_pages(turn.asked_pages);
    turn.bricks = std::min(turn.asked_bricks, make_room(turn.asked_bricks));
    turn.evicted = evicted_;
    build(turn.bricks);
    machine_.each(turn.asked_bricks - turn.bricks, ForgetRequests{table(), bricks_.data() + turn.bricks});
    machine_.each(1, EndTurn{counters_.data()});
    return turn;
  }

  /// Frees all memory except the entries of all blocks, which it returns in the layout of BrickTable. Nothing more
  /// can be brought in.
  Array<BrickEntry> take_table() {
    keys_ = Array<std::uint64_t>(0);
    numbers_ = Array<std::uint32_t>(0);
    blocks_ = Array<BlockId>(0);
    values_ = Array<float>(0);
    bricks_ = Array<BlockId>(0);
    const Int3 count = BrickTable::blocks(source_.lattice());
    const std::uint32_t size =
        static_cast<std::uint32_t>(count.x) * static_cast<std::uint32_t>(count.y) * static_cast<std::uint32_t>(count.z);
    Array<BrickEntry> entries(size);
    machine_.each(size, FillBrickTable{table(), entries.data()});
    machine_.wait();
    entries_ = Array<BrickEntry>(0);
    owners_ = Array<std::uint32_t>(0);
    stamps_ = Array<std::uint32_t>(0);
    free_ = Array<std::uint32_t>(0);
    middles_ = Array<float>(0);
    return entries;
  }

  /// Throws Error(input) if a decoded block is damaged. Waits for all work first.
  void check() {
    read_counters();
    source_.check();
  }

 private:
  static constexpr std::uint32_t kNoRegion = ~0U;

  // Returns the size of the hash table: a power of two, so large that at most half of it is taken.
  static std::size_t number_slots(const BrickPlan& plan) {
    std::size_t size = 16;
    while (size < std::size_t{2} * 8 * plan.blocks) size *= 2;
    return size;
  }

  BrickSlots slots() const {
    return {owners_.data(), stamps_.data(), free_.data(), middles_.data(), plan_.slots, plan_.across, plan_.down};
  }

  void read_counters() { counters_.download(std::span(&seen_, 1)); }

  // Brings in the first `asked` of the requested regions, or as many of them as find a page.
  std::uint32_t serve_pages(std::uint32_t asked) {
    if (asked == 0) return 0;
    std::vector<std::uint32_t> regions(asked);
    wanted_regions_.download(regions);
    if (asked > free_pages_.size()) drop_pages(asked - static_cast<std::uint32_t>(free_pages_.size()));
    const std::size_t served = std::min<std::size_t>(asked, free_pages_.size());
    listed_regions_.upload(regions);
    machine_.each(asked - static_cast<std::uint32_t>(served),
                  ForgetRegions{regions_.data(), listed_regions_.data() + served});
    regions.resize(served);
    fill_pages(regions);
    return static_cast<std::uint32_t>(served);
  }

  void fill_pages(const std::vector<std::uint32_t>& regions) {
    if (regions.empty()) return;
    const auto count = static_cast<std::uint32_t>(regions.size());
    std::vector<std::uint32_t> pages;
    for (const std::uint32_t region : regions) {
      pages.push_back(free_pages_.back());
      free_pages_.pop_back();
      page_regions_[pages.back()] = region;
    }
    listed_regions_.upload(regions);
    listed_pages_.upload(pages);
    machine_.each(
        count, PlacePages{regions_.data(), page_stamps_.data(), listed_regions_.data(), listed_pages_.data(), turn_});
    source_.fill_pages(listed_regions_.data(), listed_pages_.data(), count, table());
  }

  // Frees `wanted` pages that were unused for the longest time, but none that was used since the last turn.
  void drop_pages(std::uint32_t wanted) {
    const std::uint32_t free_before = seen_.free_slots;
    machine_.each(kRegionBlocks * plan_.pages, StampPages{entries_.data(), page_stamps_.data(), turn_});
    std::vector<std::uint32_t> stamps(page_stamps_.size());
    page_stamps_.download(stamps);
    std::vector<std::uint32_t> pages;
    for (std::uint32_t page = 1; page <= plan_.pages; ++page) {
      if (page_regions_[page] != kNoRegion && stamps[page] != turn_) pages.push_back(page);
    }
    std::ranges::sort(pages, {}, [&](std::uint32_t page) { return stamps[page]; });
    pages.resize(std::min<std::size_t>(pages.size(), wanted));
    if (pages.empty()) return;
    std::vector<std::uint32_t> regions;
    for (const std::uint32_t page : pages) {
      regions.push_back(std::exchange(page_regions_[page], kNoRegion));
      free_pages_.push_back(page);
    }
    listed_regions_.upload(regions);
    listed_pages_.upload(pages);
    machine_.each(kRegionBlocks * static_cast<std::uint32_t>(pages.size()),
                  DropPages{table(), slots(), counters_.data(), turn_, listed_regions_.data(), listed_pages_.data()});
    read_counters();
    evicted_ += seen_.free_slots - free_before;
  }

  // Evicts bricks until `wanted` slots are free, but no brick that was used since the last turn. Returns how many are
  // free.
  std::uint32_t make_room(std::uint32_t wanted) {
    if (wanted <= seen_.free_slots) return seen_.free_slots;
    const std::uint32_t needed = wanted - seen_.free_slots;
    std::uint32_t old = 0;
    std::uint32_t age = BrickCounters::kAges;
    while (age > 1 && old < needed) old += seen_.ages[--age];
    const std::uint32_t evicted = std::min(old, needed);
    if (evicted > 0) {
      machine_.each(plan_.slots, EvictSlots{slots(), entries_.data(), counters_.data(), turn_, age, evicted});
    }
    evicted_ += evicted;
    return seen_.free_slots + evicted;
  }

  // Builds the first `count` of the requested bricks, as many together as there is room for the values of their
  // blocks.
  void build(std::uint32_t count) {
    for (std::uint32_t first = 0; first < count;) {
      const std::uint32_t some = std::min(batch_, count - first);
      const BlockId* bricks = bricks_.data() + first;
      const BlockNumbers numbers = number_blocks(bricks, some);
      if (seen_.blocks > plan_.blocks) {
        batch_ = some / 2;
        continue;
      }
      source_.decode(blocks_.data(), seen_.blocks, values_.data());
      BrickCounters* counters = counters_.data();
      machine_.groups(some,
                      BuildBricks<Texels>{table(), slots(), counters, numbers, values_.data(), bricks, turn_, texels_});
      machine_.each(1, EndBatch{counters, some});
      if (some == batch_ && seen_.blocks < plan_.blocks / 2) batch_ = std::min(2 * batch_, plan_.blocks);
      first += some;
    }
  }

  BlockNumbers number_blocks(const BlockId* bricks, std::uint32_t count) {
    BrickCounters* counters = counters_.data();
    const BlockNumbers numbers{keys_.data(), numbers_.data(), static_cast<std::uint32_t>(keys_.size() - 1),
                               blocks_.data(), &counters->blocks};
    machine_.clear(keys_);
    machine_.each(1, BeginBatch{counters});
    machine_.each(8 * count, NumberBlocks{source_.lattice(), bricks, numbers});
    read_counters();
    return numbers;
  }

  Machine machine_;
  BlockSource& source_;
  BrickPlan plan_;
  Texels texels_;
  Array<RegionEntry> regions_;
  Array<BrickEntry> entries_;
  Array<std::uint32_t> page_stamps_;
  std::vector<std::uint32_t> page_regions_;  // by page
  std::vector<std::uint32_t> free_pages_;
  Array<std::uint32_t> owners_;
  Array<std::uint32_t> stamps_;
  Array<std::uint32_t> free_;
  Array<float> middles_;
  Array<BrickCounters> counters_;
  Array<BlockId> bricks_;                // requested
  Array<std::uint32_t> wanted_regions_;  // requested
  Array<std::uint32_t> listed_regions_;  // list for one step
  Array<std::uint32_t> listed_pages_;    // list for one step
  Array<std::uint64_t> keys_;
  Array<std::uint32_t> numbers_;
  Array<BlockId> blocks_;
  Array<float> values_;
  std::uint32_t batch_;  // number of bricks whose blocks probably fit
  BrickCounters seen_;
  std::uint32_t turn_ = 0;
  std::uint32_t evicted_ = 0;  // bricks evicted in this turn
};

}  // namespace weir
