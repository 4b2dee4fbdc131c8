#include "format/io/reused_pages.h"

#include <sys/mman.h>

#include <exception>

namespace weir {

ReusedPages& ReusedPages::of_process() {
  static auto* const pages = new ReusedPages;  // never destroyed: static objects that are files may outlive it
  return *pages;
}

std::span<std::byte> ReusedPages::take(std::size_t bytes) {
  constexpr std::size_t kMostTimes = 2;
  if (bytes < kLeast) return {};
  const std::lock_guard lock(mutex_);
  return held_.take(bytes, kMostTimes, [](const auto&) { return true; }).value_or(std::span<std::byte>());
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
    held_.add(mapping.size(), mapping);
  } catch (const std::exception&) {  // no memory for the list
    return false;
  }
  return true;
}

void ReusedPages::clear() { unmap_down_to(0); }

std::size_t ReusedPages::held_bytes() const {
  const std::lock_guard lock(mutex_);
  return held_.bytes();
}

void ReusedPages::unmap_down_to(std::size_t bytes) noexcept {
  const auto take_oldest = [&] {
    const std::lock_guard lock(mutex_);
    return held_.bytes() > bytes ? held_.take_oldest() : std::nullopt;
  };
  // munmap takes long, so it runs without the lock.
  while (const auto oldest = take_oldest()) ::munmap(oldest->data(), oldest->size());
}

}  // namespace weir
