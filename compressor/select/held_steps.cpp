#include "compressor/select/held_steps.h"

namespace weir {

bool HeldSteps::Part::grow() {
  if (all_->overflown_ || all_->chunk_count_++ >= all_->most_chunks_) {
    all_->overflown_ = true;
    chunks_.clear();  // of use to nobody
    return false;
  }
  chunks_.emplace_back(kChunkBytes);
  next_ = reinterpret_cast<Step*>(chunks_.back().bytes().data());
  room_ = kChunkBytes / sizeof(Step);
  return true;
}

OutsideSums HeldSteps::outside() const {
  OutsideSums sums;
  for (const Part& part : parts_) sums += part.outside_;
  return sums;
}

std::vector<std::span<const HeldSteps::Step>> HeldSteps::chunks() const {
  std::vector<std::span<const Step>> all;
  for (const Part& part : parts_) {
    for (const PageBuffer& chunk : part.chunks_) {
      const std::size_t left = &chunk == &part.chunks_.back() ? part.room_ : 0;
      all.emplace_back(reinterpret_cast<const Step*>(chunk.bytes().data()), kChunkBytes / sizeof(Step) - left);
    }
  }
  return all;
}

}  // namespace weir
