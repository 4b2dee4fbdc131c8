// Work that may be left undone, by a thread of its own.
#pragma once

#include <memory>
#include <system_error>
#include <thread>
#include <utility>

namespace weir {

/// Does it meanwhile; nothing where there is no thread for it.
template <class Work>
std::jthread start_beside(Work work) {
  try {
    return std::jthread(std::move(work));
  } catch (const std::system_error&) {
    return {};
  }
}

/// Frees its memory meanwhile, which takes a second for 5 GB; at once where there is no thread for it.
template <class T>
std::jthread released(std::unique_ptr<T> memory) {
  if (memory == nullptr) return {};
  return start_beside([memory = std::move(memory)]() mutable { memory.reset(); });
}

}  // namespace weir
