// Starts work on a thread of its own. The work is not done if no thread can be started.
#pragma once

#include <memory>
#include <system_error>
#include <thread>
#include <utility>

namespace weir {

/// Does `work` on a new thread. If no thread can be started, does nothing and returns an empty thread.
template <class Work>
std::jthread start_beside(Work work) {
  try {
    return std::jthread(std::move(work));
  } catch (const std::system_error&) {
    return {};
  }
}

/// Frees `memory` on a new thread, because freeing 5 GB takes a second. If no thread can be started, frees it before
/// returning.
template <class T>
std::jthread released(std::unique_ptr<T> memory) {
  if (memory == nullptr) return {};
  return start_beside([memory = std::move(memory)]() mutable { memory.reset(); });
}

}  // namespace weir
