#include "ingest/drivers/hdf5_crash.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

// The line of the thread's Hdf5Call. A signal handler can only read data that lives as long as the program.
thread_local const std::string* line_now = nullptr;
std::atomic<const Hdf5Reads*> reads_now{nullptr};
std::atomic<const std::vector<std::string>*> removed_now{nullptr};
static_assert(std::atomic<const std::string*>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a handler reads them");

// Returns the line of the calling thread; nullptr if the thread is not in the library.
const std::string* line_of_thread() {
  if (line_now != nullptr) return line_now;
  const Hdf5Reads* const reads = reads_now;
  return reads != nullptr && reads->thread == ::gettid() ? reads->line.load() : nullptr;
}

// The stall line of the thread's Hdf5Call.
thread_local const std::string* stall_line_now = nullptr;
std::atomic<std::int64_t> longest_ms{0};
// A signal that nothing else in weir's programs uses.
constexpr int kStalled = SIGVTALRM;

constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGABRT};

// Calls only functions that POSIX allows in a signal handler.
[[noreturn]] void end_with(const std::string& line) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line.data(), line.size());
  if (const std::vector<std::string>* const paths = removed_now) {
    for (const std::string& path : *paths) {
      if (::unlink(path.c_str()) != 0) ::rmdir(path.c_str());
    }
  }
  ::_exit(static_cast<int>(ErrorKind::input));
}

bool wants_own_stack(int signal) {
  struct sigaction now {};
  return ::sigaction(signal, nullptr, &now) == 0 && (now.sa_flags & SA_ONSTACK) != 0;
}

/// A signal stack for the thread that makes it, unless the thread has one. It ends with the thread.
class HandlerStack {
 public:
  HandlerStack() {
    stack_t now{};
    if (::sigaltstack(nullptr, &now) != 0 || (now.ss_flags & SS_DISABLE) == 0) return;
    bytes_.resize(kBytes);
    stack_t own{};
    own.ss_sp = bytes_.data();
    own.ss_size = bytes_.size();
    ::sigaltstack(&own, nullptr);
  }
  ~HandlerStack() {
    if (bytes_.empty()) return;
    stack_t none{};
    none.ss_flags = SS_DISABLE;
    ::sigaltstack(&none, nullptr);
  }
  HandlerStack(const HandlerStack&) = delete;
  HandlerStack& operator=(const HandlerStack&) = delete;

 private:
  static constexpr std::size_t kBytes = 65536;  // the kernel saves all registers there, 11 KB with AMX

  std::vector<std::byte> bytes_;
};

// When this handler runs, the signal has its default action again (SA_RESETHAND).
void end_crashed(int signal) {
  const std::string* const line = line_of_thread();
  if (line != nullptr) end_with(*line);
  ::raise(signal);  // delivered when the handler returns
}

void end_stalled(int) {
  if (stall_line_now != nullptr) end_with(*stall_line_now);
}

// Starts a timer that sends kStalled to this thread after it has computed for longest_ms. Returns nullopt if there is
// no limit or the system has no timer.
std::optional<timer_t> start_timer() {
  const std::int64_t longest = longest_ms;
  timer_t timer = nullptr;
  struct sigevent event {};
  event.sigev_notify = SIGEV_THREAD_ID;
  event.sigev_signo = kStalled;
  event._sigev_un._tid = ::gettid();
  if (longest == 0 || ::timer_create(CLOCK_THREAD_CPUTIME_ID, &event, &timer) != 0) return std::nullopt;
  const struct itimerspec at {
    {0, 0}, { longest / 1000, longest % 1000 * 1'000'000 }
  };
  ::timer_settime(timer, 0, &at, nullptr);
  return timer;
}

std::string one_line(std::string line) {
  // The path may have any characters.
  std::replace_if(
      line.begin(), line.end(), [](char c) { return (c >= 0 && c < 32) || c == 127; }, '?');
  return line + '\n';
}

}  // namespace

std::string hdf5_crash_line(const std::string& where) {
  return one_line(cat("weir: ", where,
                      ": the HDF5 library crashed at it; the file is damaged, or the library has a fault: copy the "
                      "file again, or write it anew"));
}

void keep_handler_stack() {
  if (!wants_own_stack(SIGSEGV)) return;
  static thread_local const HandlerStack stack;
}

void watch_hdf5_reads(const Hdf5Reads& reads) { reads_now = &reads; }

Hdf5Call::Hdf5Call(const std::string& path)
    : line_(hdf5_crash_line(path)),
      stall_line_(
          one_line(cat("weir: ", path, ": the HDF5 library came to no end at it in ", longest_ms / 1000,
                       " s of computing; the file is damaged, or the library has a fault: copy the file again, or "
                       "write it anew"))) {
  keep_handler_stack();
  line_now = &line_;
  stall_line_now = &stall_line_;
  timer_ = start_timer();
}

Hdf5Call::~Hdf5Call() {
  if (timer_) ::timer_delete(*timer_);
  stall_line_now = nullptr;
  line_now = nullptr;
}

Hdf5CrashRemoval::Hdf5CrashRemoval(std::vector<std::string> paths) : paths_(std::move(paths)) { removed_now = &paths_; }

Hdf5CrashRemoval::~Hdf5CrashRemoval() { removed_now = nullptr; }

void report_hdf5_crashes(std::chrono::milliseconds longest) {
  struct sigaction stalled {};
  stalled.sa_handler = end_stalled;
  stalled.sa_flags = SA_RESTART;
  ::sigemptyset(&stalled.sa_mask);
  if (::sigaction(kStalled, &stalled, nullptr) == 0) longest_ms = longest.count();
  for (const int signal : kCrashes) {
    struct sigaction now {};
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) continue;
    struct sigaction action {};
    action.sa_handler = end_crashed;
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_ONSTACK;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
  }
}

}  // namespace weir
