#include "ingest/plan/for_pieces.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace weir {

void for_pieces(std::int64_t count, std::size_t threads, const std::function<void(std::int64_t)>& work) {
  std::atomic<std::int64_t> next{0};
  std::mutex mutex;
  std::exception_ptr failure;
  const auto run = [&] {
    try {
      for (std::int64_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      next = count;
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
  };

  {
    const auto team = std::min<std::int64_t>(static_cast<std::int64_t>(threads), count);
    std::vector<std::jthread> helpers;
    helpers.reserve(static_cast<std::size_t>(std::max<std::int64_t>(team, 1)));
    try {
      for (std::int64_t i = 1; i < team; ++i) helpers.emplace_back(run);
    } catch (const std::system_error&) {
      // The system has no more threads. Those that exist do the work.
    }
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace weir
