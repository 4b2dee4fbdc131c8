#include "gpu/cuda/encode/pinned_pool.h"

#include <algorithm>
#include <utility>

namespace weir {

PinnedPool& PinnedPool::of_process() {
  static auto* const pool = new PinnedPool;  // the runtime may be gone when static objects are
  return *pool;
}

std::optional<PinnedPool::Piece> PinnedPool::take(std::size_t bytes, std::string& refusal) {
  // A program that resets its device takes what is locked for it.
  while (std::optional<Piece> piece = take_held(bytes)) {
    if (piece->memory.is_locked()) return piece;
  }
  std::optional<PinnedMemory> memory = PinnedMemory::make(bytes, refusal);
  if (!memory) return std::nullopt;
  return Piece{std::move(*memory), bytes};
}

std::optional<PinnedPool::Piece> PinnedPool::take_held(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  auto best = pieces_.end();
  for (auto piece = pieces_.begin(); piece != pieces_.end(); ++piece) {
    if (piece->bytes >= bytes && (best == pieces_.end() || piece->bytes < best->bytes)) best = piece;
  }
  if (best == pieces_.end()) return std::nullopt;
  std::optional<Piece> taken(std::move(*best));
  pieces_.erase(best);
  bytes_ -= taken->bytes;
  return taken;
}

void PinnedPool::give_back(Piece piece) {
  const std::lock_guard lock(mutex_);
  if (bytes_ + piece.bytes > kMostHeld) return;
  bytes_ += piece.bytes;
  pieces_.push_back(std::move(piece));
}

void PinnedPool::clear() {
  const std::lock_guard lock(mutex_);
  pieces_.clear();
  bytes_ = 0;
}

std::size_t PinnedPool::held_bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace weir
