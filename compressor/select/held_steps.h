// Holds the steps that a selection can buy in memory as one pass over the rows finds them, so that no further pass is
// needed to find the cut. If a window is known, only steps near the cut are held. If there are too many steps, none are
// kept, and only with `counts` (for a size) are their bytes counted.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compressor/packed/packed_ladder.h"
#include "compressor/select/key_counts.h"
#include "compressor/select/leaf_choice.h"
#include "compressor/select/step_keys.h"
#include "compressor/select/step_pieces.h"

namespace weir {

/// Holds the steps with keys in a range, and only the sums of bytes and of saved errors of all other steps. The steps
/// of one thread lie together.
class HeldSteps {
 public:
  /// The opening of a region, or a step of a leaf in it.
  class Step {
   public:
    static Step opening(std::int64_t region, double key, double gain) { return {region, key, gain, 0}; }
    /// `position` is the leaf's position in the region.
    static Step of_leaf(std::int64_t region, double key, std::size_t position, const LeafStep& step) {
      const auto of_leaf = static_cast<std::uint32_t>(position) | std::uint32_t{step.level} << kPositionBits;
      return {region, key, step.gain, of_leaf | step.bytes << kBytesShift};
    }

    double key;
    double gain;
    std::int32_t region;

    bool opens() const { return level() == 0; }
    /// Returns the bytes by which the step makes the file grow: `region_bytes` if it opens a region.
    std::uint32_t bytes(std::uint64_t region_bytes) const {
      return opens() ? static_cast<std::uint32_t>(region_bytes) : leaf_ >> kBytesShift;
    }
    std::size_t position() const { return leaf_ & ((1U << kPositionBits) - 1U); }
    KeptLevel level() const { return static_cast<KeptLevel>(leaf_ >> kPositionBits & ((1U << kLevelBits) - 1U)); }

   private:
    Step(std::int64_t of_region, double of_key, double of_gain, std::uint32_t leaf)
        : key(of_key), gain(of_gain), region(static_cast<std::int32_t>(of_region)), leaf_(leaf) {}

    static constexpr unsigned kPositionBits = 12;
    static constexpr unsigned kLevelBits = 6;
    static constexpr unsigned kBytesShift = kPositionBits + kLevelBits;
    static_assert(LeafChoices::kLeaves == 1U << kPositionBits && kExactLevel < 1U << kLevelBits);
    static_assert(nvdb::kFloatLeafBytes < 1U << (32 - kBytesShift), "no step takes more");

    std::uint32_t leaf_;
  };

  /// Takes up to `most_bytes` of memory as needed. Opening a region takes `region_bytes` in the file. `counts`: whether
  /// the bytes of steps without room are counted. Saved errors are summed in units of `unit`, unless `unit` is 0.
  HeldSteps(const KeyRange& range, std::uint64_t most_bytes, std::uint64_t region_bytes, bool counts = false,
            double unit = 0)
      : range_(range), pieces_(most_bytes), region_bytes_(region_bytes), counting_(counts), unit_(unit) {}
  HeldSteps(const HeldSteps&) = delete;
  HeldSteps& operator=(const HeldSteps&) = delete;

  /// Returns the memory in bytes for `steps` steps, found by this machine's threads.
  static std::uint64_t bytes_for(std::uint64_t steps);

  /// The steps of one thread. Steps with a key of 0 are ignored because they are never bought.
  class Part {
   public:
    explicit Part(HeldSteps& all) : all_(&all) {}
    void add(const Step& step) {
      if (!(step.key > 0)) return;
      if (!all_->range_.holds(step.key)) {
        outside_.add(all_->range_, step.key, {step.bytes(all_->region_bytes_), 1});
        if (all_->unit_ > 0) outside_gains_.add(all_->range_, step.key, {gain_weight(step.gain, all_->unit_), 1});
      } else if (!counts_ && (room_ > 0 || grow())) {
        *next_++ = step;
        --room_;
      } else if (counts_) {
        counts_->add(step.key, step.bytes(all_->region_bytes_));
      }
    }
    /// Returns the number of steps held. One thread adds all steps of a region, one after the other.
    std::size_t size() const { return pieces_.size() * kPieceSteps - room_; }
    /// Calls visit(step) for `count` steps from step `first` on.
    template <typename Visit>
    void for_each(std::size_t first, std::size_t count, const Visit& visit) const {
      for (std::size_t i = first; i < first + count; ++i) {
        visit(reinterpret_cast<const Step*>(pieces_[i / kPieceSteps].data())[i % kPieceSteps]);
      }
    }

   private:
    friend class HeldSteps;
    bool grow();
    std::vector<std::span<const Step>> steps() const;
    void count_into(KeyCounts& counts) const;

    HeldSteps* all_;
    std::vector<std::span<std::byte>> pieces_;
    Step* next_ = nullptr;
    std::size_t room_ = 0;  // steps that still fit the last piece
    OutsideSums outside_;
    OutsideSums outside_gains_;
    std::unique_ptr<KeyCounts> counts_;  // of the range, once steps find no room
  };
  Part& part() { return parts_.local(); }

  /// Returns whether every step of the range is held.
  bool complete() const { return !overflown_; }
  /// Returns whether adding further steps is useful.
  bool takes_more() const { return complete() || counting_; }
  /// Returns the counts of all steps, held or counted. Those inside the range are valid if complete() or if bytes are
  /// counted.
  KeyCounts counts() const;
  const KeyRange& range() const { return range_; }
  /// Returns the bytes of the steps outside the range.
  OutsideSums outside() const { return sum_of(&Part::outside_); }
  /// Returns the error that the steps outside the range save, in units of unit().
  OutsideSums outside_gains() const { return sum_of(&Part::outside_gains_); }
  double unit() const { return unit_; }
  /// Returns the held steps, in no order.
  std::vector<std::span<const Step>> steps() const;

 private:
  static constexpr std::size_t kPieceSteps = StepPieces::kPieceBytes / sizeof(Step);

  OutsideSums sum_of(OutsideSums Part::*sums) const {
    OutsideSums sum;
    for (const Part& part : parts_) sum += part.*sums;
    return sum;
  }

  KeyRange range_;
  StepPieces pieces_;
  std::uint64_t region_bytes_;
  bool counting_;
  double unit_;
  std::atomic<bool> overflown_ = false;
  tbb::enumerable_thread_specific<Part> parts_{[this] { return Part(*this); }};
};

}  // namespace weir
