#include "tools/interrupt.h"

#include <atomic>
#include <csignal>

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

int exit_code_of(const Error& error) {
  return error.kind() == ErrorKind::interrupted && hung_up ? 128 + SIGHUP : error.exit_code();
}

}  // namespace weir
