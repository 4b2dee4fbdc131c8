// The steps that a selection can buy, where a window is known those about its cut, held in memory as a pass over the
// rows finds them, so that the cut among them is found without further passes; where they are too many, what they take.
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

/// Holds the steps whose keys lie in a range; of all others only the sums of bytes and of saved errors. Steps of one
/// thread lie together.
class HeldSteps {
 public:
  /// The opening of a region, or a step of a leaf in it.
  class Step {
   public:
    static Step opening(std::int64_t region, double key, double gain) { return {region, key, gain, 0}; }
    /// `position` is the leaf's.
    static Step of_leaf(std::int64_t region, double key, std::size_t position, const LeafStep& step) {
      const auto of_leaf = static_cast<std::uint32_t>(position) | std::uint32_t{step.level} << kPositionBits;
      return {region, key, step.gain, of_leaf | step.bytes << kBytesShift};
    }

    double key;
    double gain;
    std::int32_t region;

    bool opens() const { return level() == 0; }
    /// What the file grows by; `region_bytes` where it opens a region.
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

  /// Takes up to `most_bytes` of memory, as it is needed. An opening takes `region_bytes` in the file. `counts`:
  /// whether the bytes of steps that find no room are counted. Saved errors are summed in units of `unit`, unless that
  /// is 0.
  HeldSteps(const KeyRange& range, std::uint64_t most_bytes, std::uint64_t region_bytes, bool counts = false,
            double unit = 0)
      : range_(range), pieces_(most_bytes), region_bytes_(region_bytes), counting_(counts), unit_(unit) {}
  HeldSteps(const HeldSteps&) = delete;
  HeldSteps& operator=(const HeldSteps&) = delete;

  /// Memory for so many steps of this machine's threads.
  static std::uint64_t bytes_for(std::uint64_t steps);

  /// One thread's. Keys of 0 are never bought.
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
    /// How many it holds: those of a region are added by one thread, one after the other.
    std::size_t size() const { return pieces_.size() * kPieceSteps - room_; }
    /// Calls visit(step) for those from `first` on, so many.
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
    std::size_t room_ = 0;  // steps that the last piece still takes
    OutsideSums outside_;
    OutsideSums outside_gains_;
    std::unique_ptr<KeyCounts> counts_;  // of the range, in place of steps
  };
  Part& part() { return parts_.local(); }

  /// Whether every step of the range is held.
  bool complete() const { return !overflown_; }
  /// Whether further steps are of use.
  bool takes_more() const { return complete() || counting_; }
  /// Of all steps, held or counted; those of the range where it counts, or is complete.
  KeyCounts counts() const;
  const KeyRange& range() const { return range_; }
  /// Bytes of the others.
  OutsideSums outside() const { return sum_of(&Part::outside_); }
  /// What the others save, in units of unit().
  OutsideSums outside_gains() const { return sum_of(&Part::outside_gains_); }
  double unit() const { return unit_; }
  /// In no order.
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
