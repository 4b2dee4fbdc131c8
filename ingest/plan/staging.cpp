#include "ingest/plan/staging.h"

namespace weir {
namespace {

constexpr std::size_t kBufferBytes = kStagingBytes / kIoThreads;

}  // namespace

StagingPool::StagingPool() : memory_(kStagingBytes) {
  free_.reserve(kIoThreads);
  for (std::size_t i = 0; i < kIoThreads; ++i) {
    free_.push_back(memory_.bytes().subspan(i * kBufferBytes, kBufferBytes));
  }
}

std::span<std::byte> StagingPool::acquire() {
  std::unique_lock lock(mutex_);
  returned_.wait(lock, [this] { return !free_.empty(); });
  const auto buffer = free_.back();
  free_.pop_back();
  return buffer;
}

void StagingPool::release(std::span<std::byte> buffer) {
  {
    const std::lock_guard lock(mutex_);
    free_.push_back(buffer);
  }
  returned_.notify_one();
}

}  // namespace weir
