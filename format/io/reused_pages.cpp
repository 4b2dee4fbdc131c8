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
  const std::lock_guard lock(mutex_);
  try {
    if (held) {
      while (bytes_ + mapping.size() > kMostHeld) unmap_oldest();
      mappings_.push_back(mapping);
      bytes_ += mapping.size();
      return;
    }
  } catch (const std::exception&) {
    // No memory for the list.
  }
  ::munmap(mapping.data(), mapping.size());
}

void ReusedPages::clear() {
  const std::lock_guard lock(mutex_);
  while (!mappings_.empty()) unmap_oldest();
}

std::size_t ReusedPages::held_bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void ReusedPages::unmap_oldest() {
  const std::span<std::byte> oldest = mappings_.front();
  mappings_.pop_front();
  bytes_ -= oldest.size();
  ::munmap(oldest.data(), oldest.size());
}

}  // namespace weir
