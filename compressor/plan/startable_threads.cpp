#include "compressor/plan/startable_threads.h"

#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <latch>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/process/fault.h"
#include "ingest/plan/staging.h"

namespace weir {
namespace {

// Returns the number of links of /proc/self/task, which has one directory per thread; 0 if it cannot be read.
std::size_t threads_of_process() {
  struct stat tasks {};
  return ::stat("/proc/self/task", &tasks) == 0 ? static_cast<std::size_t>(tasks.st_nlink) : 0;
}

std::size_t start_threads(std::size_t wanted) {
  std::latch counted(1);  // before the threads, which are joined first
  std::vector<std::jthread> started;
  started.reserve(wanted);
  try {
    while (started.size() < wanted) started.emplace_back([&counted] { counted.wait(); });
  } catch (const std::system_error&) {
    // the threads that did start are counted below
  } catch (...) {
    counted.count_down();
    throw;
  }
  const std::size_t count = started.size();
  counted.count_down();
  return count;
}

}  // namespace

std::size_t startable_threads(std::size_t wanted) {
  using Clock = std::chrono::steady_clock;
  static std::mutex mutex;
  static std::size_t started = 0;
  static std::size_t beside = 0;  // threads of the process at that time
  static pid_t process = 0;       // a forked child must not use its parent's result
  static Clock::time_point at{};
  const std::lock_guard lock(mutex);  // two callers that start threads at once would count too few
  const std::size_t running = threads_of_process();
  const bool known = process == ::getpid() && running <= beside && Clock::now() - at < kStartableFor;
  if (known && wanted <= started) return wanted;
  started = start_threads(wanted);
  beside = running;
  process = ::getpid();
  at = Clock::now();
  return started;
}

std::size_t startable_workers(std::size_t threads, const Notice& notice) {
  constexpr std::size_t kOthers = 2 * kIoThreads + 2;  // two readers with their helpers, and two more
  const std::size_t wanted = threads - 1 + kOthers;
  const std::size_t startable = startable_threads(wanted);
  if (startable < 2) throw Error(ErrorKind::io, kNoMoreThreads);  // one reads, and oneTBB may start one for itself
  if (startable >= wanted) return threads;
  const std::size_t workers = startable > kOthers ? startable - kOthers + 1 : 1;
  if (notice) {
    notice(cat("the system lets this process start ", startable, " threads more; working on ", workers,
               "; raise the limit of processes (ulimit -u)"));
  }
  return workers;
}

}  // namespace weir
