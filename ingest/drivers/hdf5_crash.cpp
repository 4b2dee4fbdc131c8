#include "ingest/drivers/hdf5_crash.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

// Of the thread's Hdf5Call. A handler can be told nothing but by what lives as long as the program.
thread_local const std::string* line_now = nullptr;
std::atomic<const Hdf5Reads*> reads_now{nullptr};
std::atomic<const std::vector<std::string>*> removed_now{nullptr};
static_assert(std::atomic<const std::string*>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a handler reads them");

// Of the thread that calls it; null where it is not in the library.
const std::string* line_of_thread() {
  if (line_now != nullptr) return line_now;
  const Hdf5Reads* const reads = reads_now;
  return reads != nullptr && reads->thread == ::gettid() ? reads->line.load() : nullptr;
}

constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGABRT};

// Calls nothing but what POSIX allows in a handler. The signal has its default action again (SA_RESETHAND).
void end_with_message(int signal) {
  const std::string* const line = line_of_thread();
  if (line == nullptr) {
    ::raise(signal);  // it comes when the handler returns
    return;
  }
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line->data(), line->size());
  if (const std::vector<std::string>* const paths = removed_now) {
    for (const std::string& path : *paths) {
      if (::unlink(path.c_str()) != 0) ::rmdir(path.c_str());
    }
  }
  ::_exit(static_cast<int>(ErrorKind::input));
}

}  // namespace

std::string hdf5_crash_line(const std::string& where) {
  std::string line = cat("weir: ", where,
                         ": the HDF5 library crashed at it; the file is damaged, or the library has a fault: copy the "
                         "file again, or write it anew");
  // One line, whatever characters the path has.
  std::replace_if(
      line.begin(), line.end(), [](char c) { return (c >= 0 && c < 32) || c == 127; }, '?');
  return line + '\n';
}

void watch_hdf5_reads(const Hdf5Reads& reads) { reads_now = &reads; }

Hdf5Call::Hdf5Call(const std::string& path) : line_(hdf5_crash_line(path)) { line_now = &line_; }

Hdf5Call::~Hdf5Call() { line_now = nullptr; }

Hdf5CrashRemoval::Hdf5CrashRemoval(std::vector<std::string> paths) : paths_(std::move(paths)) { removed_now = &paths_; }

Hdf5CrashRemoval::~Hdf5CrashRemoval() { removed_now = nullptr; }

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
