#include "format/process/fork_guard.h"

#include <pthread.h>

#include <atomic>
#include <mutex>

#include "format/base/error.h"

namespace weir {
namespace {

std::atomic<int> guards{0};
std::atomic<bool> forked{false};

void in_child() {
  if (guards > 0) forked = true;
}

// If there is no memory for the handler, nothing is refused.
void watch_forks() {
  static std::once_flag watched;
  std::call_once(watched, [] { pthread_atfork(nullptr, nullptr, in_child); });
}

}  // namespace

ForkGuard::ForkGuard() {
  watch_forks();
  refuse_forked();
  ++guards;
}

ForkGuard::~ForkGuard() { --guards; }

void refuse_forked() {
  if (!forked) return;
  throw Error(ErrorKind::usage,
              "this process was forked while its parent converted or rendered, and has none of the threads for it; "
              "start it by exec (in Python: multiprocessing with \"spawn\"), or fork it before");
}

}  // namespace weir
