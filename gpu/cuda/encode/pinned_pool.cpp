#include "gpu/cuda/encode/pinned_pool.h"

#include <cuda_runtime_api.h>

#include <exception>
#include <utility>

#include "gpu/cuda/runtime/current_device.h"

namespace weir {
namespace {

using ContextId = int (*)(void* context, unsigned long long* id);  // cuCtxGetId; a null context is the current one

ContextId find_context_id() {
  void* found = nullptr;
  cudaDriverEntryPointQueryResult result{};
#if CUDART_VERSION >= 12050
  const cudaError_t code = cudaGetDriverEntryPointByVersion("cuCtxGetId", &found, 12000, cudaEnableDefault, &result);
#else
  const cudaError_t code = cudaGetDriverEntryPoint("cuCtxGetId", &found, cudaEnableDefault, &result);
#endif
  if (code == cudaSuccess && result == cudaDriverEntryPointSuccess) return reinterpret_cast<ContextId>(found);
  cudaGetLastError();
  return nullptr;
}

// Whether what was locked in a context of a device is not any more.
bool is_gone(int device, std::uint64_t context) {
  const KeptDevice kept;
  cudaSetDevice(device);
  return device_context() != context;
}

}  // namespace

std::uint64_t device_context() {
  static const ContextId context_id = find_context_id();
  unsigned long long id = 0;
  return context_id != nullptr && context_id(nullptr, &id) == 0 ? id : 0;
}

PinnedPool& PinnedPool::of_process() {
  static auto* const pool = new PinnedPool;  // the runtime may be gone when static objects are
  return *pool;
}

std::optional<PinnedPool::Piece> PinnedPool::take(std::size_t bytes, std::string& refusal) {
  const std::uint64_t context = device_context();
  if (std::optional<Piece> held = take_held(bytes, context)) return held;
  std::optional<PinnedMemory> memory = PinnedMemory::make(bytes, refusal);
  if (!memory) return std::nullopt;
  // The context is there at the latest now.
  return Piece{std::move(*memory), bytes, current_device(), context == 0 ? device_context() : context};
}

std::optional<PinnedPool::Piece> PinnedPool::take_held(std::size_t bytes, std::uint64_t context) {
  constexpr std::size_t kMostTimes = 4;
  const std::lock_guard lock(mutex_);
  auto best = pieces_.end();
  for (auto piece = pieces_.begin(); piece != pieces_.end(); ++piece) {
    if (piece->context != context || piece->bytes < bytes || piece->bytes > kMostTimes * bytes) continue;
    if (best == pieces_.end() || piece->bytes < best->bytes) best = piece;
  }
  if (best == pieces_.end()) {
    free_oldest();
    return std::nullopt;
  }
  std::optional<Piece> taken(std::move(*best));
  pieces_.erase(best);
  bytes_ -= taken->bytes;
  return taken;
}

void PinnedPool::give_back(Piece piece) noexcept {
  if (piece.context == 0 || piece.bytes > kMostHeld) return;
  const std::lock_guard lock(mutex_);
  while (bytes_ + piece.bytes > kMostHeld) free_oldest();
  try {
    pieces_.push_back(std::move(piece));
    bytes_ += pieces_.back().bytes;
  } catch (const std::exception&) {  // no memory: it is freed
    return;
  }
}

void PinnedPool::free_oldest() {
  if (pieces_.empty()) return;
  Piece& oldest = pieces_.front();
  bytes_ -= oldest.bytes;
  if (is_gone(oldest.device, oldest.context)) oldest.memory.forget();
  pieces_.pop_front();
}

void PinnedPool::clear() {
  const std::lock_guard lock(mutex_);
  while (!pieces_.empty()) free_oldest();
}

std::size_t PinnedPool::held_bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace weir
