#include "compressor/select/held_steps.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace weir {

// The kernel takes a tenth of a second for a GB of pages, unless several threads give them back.
HeldSteps::~HeldSteps() {
  for (Part& part : parts_) {
    tbb::parallel_for(std::size_t{0}, part.chunks_.size(), [&](std::size_t i) { part.chunks_[i] = PageBuffer(0); });
  }
}

bool HeldSteps::Part::grow() {
  if (all_->overflown_ || all_->chunk_count_++ >= all_->most_chunks_) {
    all_->overflown_ = true;
    if (all_->counting_) {
      auto counts = std::make_unique<KeyCounts>(all_->range_);
      count_into(*counts);
      counts_ = std::move(counts);
    }
    chunks_.clear();  // of use to nobody
    return false;
  }
  chunks_.emplace_back(kChunkBytes);
  next_ = reinterpret_cast<Step*>(chunks_.back().bytes().data());
  room_ = kChunkSteps;
  return true;
}

std::vector<std::span<const HeldSteps::Step>> HeldSteps::Part::chunks() const {
  std::vector<std::span<const Step>> all;
  for (const PageBuffer& chunk : chunks_) {
    const std::size_t left = &chunk == &chunks_.back() ? room_ : 0;
    all.emplace_back(reinterpret_cast<const Step*>(chunk.bytes().data()), kChunkSteps - left);
  }
  return all;
}

void HeldSteps::Part::count_into(KeyCounts& counts) const {
  for (const std::span<const Step>& chunk : chunks()) {
    for (const Step& step : chunk) counts.add(step.key, step.bytes(all_->region_bytes_));
  }
}

std::uint64_t HeldSteps::bytes_for(std::uint64_t steps) {
  const auto threads = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
  return steps * sizeof(Step) + threads * kChunkBytes;
}

KeyCounts HeldSteps::counts() const {
  KeyCounts total(range_);
  for (const Part& part : parts_) {
    part.count_into(total);
    if (part.counts_) total += *part.counts_;
  }
  total.outside = outside();
  return total;
}

std::vector<std::span<const HeldSteps::Step>> HeldSteps::chunks() const {
  std::vector<std::span<const Step>> all;
  for (const Part& part : parts_) {
    const std::vector<std::span<const Step>> of_part = part.chunks();
    all.insert(all.end(), of_part.begin(), of_part.end());
  }
  return all;
}

}  // namespace weir
