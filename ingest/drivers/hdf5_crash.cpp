#include "ingest/drivers/hdf5_crash.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

// Of the thread's Hdf5Call. A handler can be told nothing but by what lives as long as the program.
thread_local const std::string* message_now = nullptr;

constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGABRT};

// Calls nothing but what POSIX allows in a handler. The signal has its default action again (SA_RESETHAND).
void end_with_message(int signal) {
  if (message_now == nullptr) {
    ::raise(signal);  // it comes when the handler returns
    return;
  }
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, message_now->data(), message_now->size());
  ::_exit(static_cast<int>(ErrorKind::input));
}

}  // namespace

Hdf5Call::Hdf5Call(const std::string& path)
    : message_(cat("weir: ", path,
                   ": the HDF5 library crashed at it; the file is damaged, or the library has a fault: copy the file "
                   "again, or write it anew")) {
  // One line, whatever characters the path has.
  std::replace_if(
      message_.begin(), message_.end(), [](char c) { return (c >= 0 && c < 32) || c == 127; }, '?');
  message_ += '\n';
  message_now = &message_;
}

Hdf5Call::~Hdf5Call() { message_now = nullptr; }

void report_hdf5_crashes() {
  for (const int signal : kCrashes) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) continue;
    struct sigaction action {};
    action.sa_handler = end_with_message;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
  }
}

}  // namespace weir
