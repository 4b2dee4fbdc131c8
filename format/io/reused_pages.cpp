#include "format/io/reused_pages.h"

#include <sys/mman.h>

#include <exception>

namespace weir {

ReusedPages& ReusedPages::of_process() {
  static auto* const pages = new ReusedPages;  // files that are static objects may outlive it otherwise
  return *pages;
}

std::span<std::byte> ReusedPages::take(std::size_t bytes) {
  constexpr std::size_t kMostTimes = 2;
  if (bytes < kLeast) return {};
  const std::lock_guard lock(mutex_);
  auto best = mappings_.end();
  for (auto mapping = mappings_.begin(); mapping != mappings_.end(); ++mapping) {
    if (mapping->size() < bytes || mapping->size() / kMostTimes > bytes) continue;
    if (best == mappings_.end() || mapping->size() < best->size()) best = mapping;
  }
  if (best == mappings_.end()) return {};
  const std::span<std::byte> taken = *best;
  mappings_.erase(best);
  bytes_ -= taken.size();
  return taken;
}

void ReusedPages::give_back(std::span<std::byte> mapping) noexcept {
  if (mapping.empty()) return;
  const bool held = mapping.size() >= kLeast && mapping.size() <= kMostHeld &&
                    ::madvise(mapping.data(), mapping.size(), MADV_FREE) == 0;
  if (!held || !hold(mapping)) ::munmap(mapping.data(), mapping.size());
  unmap_down_to(kMostHeld);
}

bool ReusedPages::hold(std::span<std::byte> mapping) noexcept {
  const std::lock_guard lock(mutex_);
  try {
    mappings_.push_back(mapping);
  } catch (const std::exception&) {  // no memory for the list
    return false;
  }
  bytes_ += mapping.size();
  return true;
}

void ReusedPages::clear() { unmap_down_to(0); }

std::size_t ReusedPages::held_bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void ReusedPages::unmap_down_to(std::size_t bytes) noexcept {
  const auto take_oldest = [&]() -> std::span<std::byte> {
    const std::lock_guard lock(mutex_);
    if (bytes_ <= bytes) return {};
    const std::span<std::byte> oldest = mappings_.front();
    mappings_.pop_front();
    bytes_ -= oldest.size();
    return oldest;
  };
  // Which takes long, and not under the lock.
  for (std::span<std::byte> oldest = take_oldest(); !oldest.empty(); oldest = take_oldest()) {
    ::munmap(oldest.data(), oldest.size());
  }
}

}  // namespace weir
