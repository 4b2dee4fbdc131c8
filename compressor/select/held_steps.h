// The steps that a selection can buy, held in memory as a pass over the rows finds them, so that the cut among them is
// found without further passes; where they are too many, what they take.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "compressor/select/key_counts.h"
#include "compressor/select/step_keys.h"
#include "ingest/plan/page_buffer.h"

namespace weir {

/// Holds the steps whose keys lie in a range; of all others only the sum of bytes. Steps of one thread lie together.
class HeldSteps {
 public:
  struct Step {
    double key;
    double gain;
    std::int32_t region;
    std::uint32_t bytes;
  };

  /// Takes up to `most_bytes` of memory, as it is needed. `counts`: whether the bytes of steps that find no room are
  /// counted.
  HeldSteps(const KeyRange& range, std::uint64_t most_bytes, bool counts = false)
      : range_(range), most_chunks_(most_bytes / kChunkBytes), counting_(counts) {}

  /// Memory for so many steps of this machine's threads.
  static std::uint64_t bytes_for(std::uint64_t steps);

  /// One thread's. Keys of 0 are never bought.
  class Part {
   public:
    explicit Part(HeldSteps& all) : all_(&all) {}
    void add(std::int64_t region, double key, std::uint64_t bytes, double gain) {
      if (!(key > 0)) return;
      if (!all_->range_.holds(key)) {
        outside_.add(all_->range_, key, {bytes, 1});
      } else if (!counts_ && (room_ > 0 || grow())) {
        *next_++ = {key, gain, static_cast<std::int32_t>(region), static_cast<std::uint32_t>(bytes)};
        --room_;
      } else if (counts_) {
        counts_->add(key, bytes);
      }
    }

   private:
    friend class HeldSteps;
    bool grow();
    std::vector<std::span<const Step>> chunks() const;
    void count_into(KeyCounts& counts) const;

    HeldSteps* all_;
    std::vector<PageBuffer> chunks_;
    Step* next_ = nullptr;
    std::size_t room_ = 0;  // steps that the last chunk still takes
    OutsideSums outside_;
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
  /// Their bytes.
  OutsideSums outside() const;
  /// In no order.
  std::vector<std::span<const Step>> chunks() const;

 private:
  static constexpr std::uint64_t kChunkBytes = std::uint64_t{1} << 18U;

  KeyRange range_;
  std::uint64_t most_chunks_;
  bool counting_;
  std::atomic<std::uint64_t> chunk_count_ = 0;
  std::atomic<bool> overflown_ = false;
  tbb::enumerable_thread_specific<Part> parts_{[this] { return Part(*this); }};
};

}  // namespace weir
