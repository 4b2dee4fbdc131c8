#include "gpu/cuda/encode/pinned_pool.h"

#include <exception>
#include <utility>

#include "gpu/cuda/runtime/current_device.h"

namespace weir {
namespace {

// Unlocks a piece. Memory that was locked in a context that is gone is no longer locked.
void unlock(PinnedPool::Piece piece) {
  if (piece.context == current_context_id()) {  // may be a context that the caller made
    const PinnedMemory unlocked = std::move(piece.memory);
    return;
  }
  if (!has_context(piece.device)) return piece.memory.forget();
  free_on(piece.device, [&] {
    void* const callers = current_context();  // may be another context of this device
    set_current_context(primary_context(piece.device));
    if (current_context_id() == piece.context) {
      const PinnedMemory unlocked = std::move(piece.memory);
    } else {
      piece.memory.forget();
    }
    set_current_context(callers);
  });
}

}  // namespace

PinnedPool& PinnedPool::of_process() {
  static auto* const pool = new PinnedPool;  // never destroyed: the CUDA runtime may be gone before static objects are
  return *pool;
}

std::optional<PinnedPool::Piece> PinnedPool::take(std::size_t bytes, std::string& refusal) {
  const std::uint64_t context = current_context_id();
  if (std::optional<Piece> held = take_held(bytes, context)) return held;
  std::optional<PinnedMemory> memory = PinnedMemory::make(bytes, refusal);
  if (!memory) return std::nullopt;
  // At this point at the latest, the context exists.
  return Piece{std::move(*memory), bytes, current_device(), context == 0 ? current_context_id() : context};
}

std::optional<PinnedPool::Piece> PinnedPool::take_held(std::size_t bytes, std::uint64_t context) {
  constexpr std::size_t kMostTimes = 4;
  const std::lock_guard lock(mutex_);
  std::optional<Piece> taken =
      held_.take(bytes, kMostTimes, [context](const Piece& piece) { return piece.context == context; });
  if (!taken) free_oldest();
  return taken;
}

void PinnedPool::give_back(Piece piece) noexcept {
  if (piece.context == 0) return;
  if (piece.bytes > kMostHeld) return unlock(std::move(piece));
  const std::lock_guard lock(mutex_);
  const std::size_t bytes = piece.bytes;
  while (held_.bytes() + bytes > kMostHeld) free_oldest();
  try {
    held_.add(bytes, std::move(piece));
  } catch (const std::exception&) {  // no memory for the list: the piece is freed
    return;
  }
}

void PinnedPool::free_oldest() {
  if (std::optional<Piece> oldest = held_.take_oldest()) unlock(std::move(*oldest));
}

void PinnedPool::clear() {
  const std::lock_guard lock(mutex_);
  while (held_.bytes() > 0) free_oldest();
}

std::size_t PinnedPool::held_bytes() const {
  const std::lock_guard lock(mutex_);
  return held_.bytes();
}

}  // namespace weir
