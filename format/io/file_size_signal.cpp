#include "format/io/file_size_signal.h"

#include <pthread.h>
#include <sys/resource.h>

#include <cerrno>
#include <ctime>

namespace weir {
namespace {

sigset_t file_size_signal() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGXFSZ);
  return set;
}

bool is_pending() {
  sigset_t pending;
  return ::sigpending(&pending) == 0 && sigismember(&pending, SIGXFSZ) == 1;
}

}  // namespace

NoFileSizeSignal::NoFileSizeSignal() {
  rlimit limit{};
  limited_ = ::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  if (!limited_) return;
  // The system sends the signal to the thread that makes the call: blocked, it stays with this thread.
  const sigset_t set = file_size_signal();
  ::pthread_sigmask(SIG_BLOCK, &set, &former_);
  pending_ = is_pending();
}

NoFileSizeSignal::~NoFileSizeSignal() {
  if (!limited_) return;
  const int reason = errno;
  const sigset_t set = file_size_signal();
  const timespec at_once{};
  while (!pending_ && is_pending() && ::sigtimedwait(&set, nullptr, &at_once) < 0 && errno == EINTR) {
  }
  ::pthread_sigmask(SIG_SETMASK, &former_, nullptr);
  errno = reason;
}

}  // namespace weir
