// Device memory and page-locked memory that calls use one after the other. It grows when a call needs more.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "gpu/cuda/encode/pinned_pool.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {

/// An array of T on the current device.
template <class T>
class GrowingArray {
 public:
  /// Returns room for `size` values. If there was less, the old values are lost. Throws Error(io).
  T* at_least(std::size_t size) {
    if (size > array_.size()) {
      array_ = DeviceArray<T>();
      array_ = DeviceArray<T>(size + size / 4);
    }
    return array_.data();
  }
  T* data() const { return array_.data(); }

 private:
  DeviceArray<T> array_;
};

class GrowingPinned {
 public:
  /// Locking pages takes a millisecond per few MiB, so this minimum makes it rare.
  static constexpr std::size_t kLeastPinned = std::size_t{1} << 21U;

  GrowingPinned() = default;
  ~GrowingPinned() { give_back(); }
  GrowingPinned(const GrowingPinned&) = delete;
  GrowingPinned& operator=(const GrowingPinned&) = delete;

  /// Returns room for `bytes`, as GrowingArray::at_least does.
  std::byte* at_least(std::size_t bytes) {
    if (!piece_ || bytes > piece_->bytes) {
      give_back();
      std::string refusal;
      const std::size_t wanted = std::max(kLeastPinned, (bytes + bytes / 8 + kMebibyte - 1) / kMebibyte * kMebibyte);
      piece_ = PinnedPool::of_process().take(wanted, refusal);
      if (!piece_) throw Error(ErrorKind::io, refusal);
    }
    return piece_->memory.data();
  }

 private:
  static constexpr std::size_t kMebibyte = std::size_t{1} << 20U;

  void give_back() {
    if (piece_) PinnedPool::of_process().give_back(std::move(*piece_));
    piece_.reset();
  }

  std::optional<PinnedPool::Piece> piece_;
};

/// Lends memory, at most `most` pieces at a time, and keeps returned memory for the next call. Thread-safe.
template <class Memory>
class MemoryPool {
 public:
  explicit MemoryPool(std::size_t most = std::numeric_limits<std::size_t>::max()) : most_(most) {}

  /// Returns memory that was given back, otherwise new memory; null if the maximum is lent already.
  std::unique_ptr<Memory> take() {
    const std::lock_guard lock(mutex_);
    if (lent_ == most_) return nullptr;
    std::unique_ptr<Memory> memory;
    if (free_.empty()) {
      memory = std::make_unique<Memory>();
    } else {
      memory = std::move(free_.back());
      free_.pop_back();
    }
    ++lent_;
    return memory;
  }
  void give_back(std::unique_ptr<Memory> memory) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(memory));
    --lent_;
  }
  /// Frees all memory that is not lent.
  void clear() {
    const std::lock_guard lock(mutex_);
    free_.clear();
  }

 private:
  const std::size_t most_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Memory>> free_;
  std::size_t lent_ = 0;
};

}  // namespace weir
