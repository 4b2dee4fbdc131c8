// Goes through items that a device works on: the device works on the next item while the host takes the last result.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>

namespace weir {

/// Calls begin(i, item) and then end(item) for each i < count, in any order and on several threads. Items are reused.
/// No more than `most_begun` items (or 2, if that is more) are between the two calls at a time. After an exception no
/// further item begins, and the exception is thrown when all threads have ended.
template <class Item, class Begin, class End>
void one_ahead(std::size_t count, std::size_t most_begun, const Begin& begin, const End& end) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> failed = false;
  const auto begin_next = [&](Item& item) {
    if (failed) return false;
    const std::size_t i = next++;
    if (i < count) begin(i, item);
    return i < count;
  };
  const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  const std::size_t workers = std::max<std::size_t>(1, std::min(most_begun / 2, threads));
  tbb::parallel_for(
      std::size_t{0}, workers,
      [&](std::size_t) {
        try {
          std::array<Item, 2> items{};
          std::size_t at = 0;
          for (bool begun = begin_next(items[0]); begun; at = 1 - at) {
            begun = begin_next(items[1 - at]);
            end(items[at]);
          }
        } catch (...) {
          failed = true;
          throw;
        }
      },
      tbb::simple_partitioner());
}

}  // namespace weir
