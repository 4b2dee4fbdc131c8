#include "compressor/select/step_pieces.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace weir {

// Several threads free the blocks, because the kernel takes a tenth of a second to free a GB of small pages.
StepPieces::~StepPieces() {
  tbb::parallel_for(std::size_t{0}, blocks_.size(), [&](std::size_t i) { blocks_[i] = PageBuffer(0); });
}

std::span<std::byte> StepPieces::next() {
  constexpr std::uint64_t kBlockPieces = 64;
  const std::lock_guard lock(mutex_);
  if (left_ == 0) return {};
  if (rest_.empty()) {
    const std::uint64_t pieces = std::min(left_, kBlockPieces);
    rest_ = blocks_.emplace_back(static_cast<std::size_t>(pieces) * kPieceBytes).bytes();
  }
  --left_;
  const std::span<std::byte> piece = rest_.first(kPieceBytes);
  rest_ = rest_.subspan(kPieceBytes);
  return piece;
}

}  // namespace weir
