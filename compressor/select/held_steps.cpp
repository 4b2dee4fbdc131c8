#include "compressor/select/held_steps.h"

namespace weir {

void HeldSteps::Part::add_outside(double key, std::uint64_t bytes) {
  const Sum one{bytes, 1};
  if (key == kRequiredKey) {
    outside_.required += one;
  } else if (key_bits(key) < all_->range_.first) {
    outside_.below += one;
  } else {
    outside_.above += one;
  }
}

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

HeldSteps::Outside HeldSteps::outside() const {
  Outside sum;
  for (const Part& part : parts_) {
    sum.required += part.outside_.required;
    sum.above += part.outside_.above;
    sum.below += part.outside_.below;
  }
  return sum;
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
