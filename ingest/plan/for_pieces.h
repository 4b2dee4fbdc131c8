// A short-lived team of threads for blocking reads. On TBB's threads such reads would starve other work.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace weir {

/// Calls `work(i)` once for each i in [0, count), started in rising order, on the calling thread and up to `threads`
/// - 1 more. The first exception stops the rest and is rethrown when all threads have ended.
void for_pieces(std::int64_t count, std::size_t threads, const std::function<void(std::int64_t)>& work);

}  // namespace weir
