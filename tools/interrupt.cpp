#include "tools/interrupt.h"

#include <atomic>
#include <csignal>

#include "format/base/error.h"
#include "tools/command.h"

namespace weir {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<bool> hung_up{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

extern "C" void on_signal(int signal) {
  if (signal == SIGHUP && !interrupted) hung_up = true;
  if (interrupted.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

const std::atomic<bool>& interrupt_flag() { return interrupted; }

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

int interrupted_exit_code() { return hung_up ? 128 + SIGHUP : static_cast<int>(ErrorKind::interrupted); }

}  // namespace weir
