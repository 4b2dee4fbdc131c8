#include "compressor/select/held_steps.h"

#include <tbb/task_arena.h>

namespace weir {

bool HeldSteps::Part::grow() {
  const std::span<std::byte> piece = all_->overflown_ ? std::span<std::byte>() : all_->pieces_.next();
  if (piece.empty()) {
    all_->overflown_ = true;
    if (all_->counting_) {
      auto counts = std::make_unique<KeyCounts>(all_->range_);
      count_into(*counts);
      counts_ = std::move(counts);
    }
    pieces_.clear();  // the steps are no longer useful; their memory is freed with the object
    return false;
  }
  pieces_.push_back(piece);
  next_ = reinterpret_cast<Step*>(piece.data());
  room_ = kPieceSteps;
  return true;
}

std::vector<std::span<const HeldSteps::Step>> HeldSteps::Part::steps() const {
  std::vector<std::span<const Step>> all;
  for (const std::span<std::byte>& piece : pieces_) {
    const std::size_t left = &piece == &pieces_.back() ? room_ : 0;
    all.emplace_back(reinterpret_cast<const Step*>(piece.data()), kPieceSteps - left);
  }
  return all;
}

void HeldSteps::Part::count_into(KeyCounts& counts) const {
  for (const std::span<const Step>& piece : steps()) {
    for (const Step& step : piece) counts.add(step.key, step.bytes(all_->region_bytes_));
  }
}

std::uint64_t HeldSteps::bytes_for(std::uint64_t steps) {
  const auto threads = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
  return steps * sizeof(Step) + threads * StepPieces::kPieceBytes;
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

std::vector<std::span<const HeldSteps::Step>> HeldSteps::steps() const {
  std::vector<std::span<const Step>> all;
  for (const Part& part : parts_) {
    const std::vector<std::span<const Step>> of_part = part.steps();
    all.insert(all.end(), of_part.begin(), of_part.end());
  }
  return all;
}

}  // namespace weir
