// Runs work that a Python program waits for, on a thread of its own without the interpreter's lock. The calling thread,
// the only one that runs Python code, passes on progress and checks for Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "format/base/message.h"

namespace weir::python {

/// The channel between the work and the calling thread. Thread-safe.
class Watch {
 public:
  struct Event {
    std::string pass;  ///< empty: `notice` is a line for the user
    std::uint64_t done = 0;
    std::uint64_t total = 0;
    Message notice;
  };

  void start(const std::string& pass, std::uint64_t total);
  void advance(std::uint64_t done);
  void notice(const Message& line);
  const std::atomic<bool>& cancelled() const { return cancelled_; }
  /// Throws Error(interrupted) if cancel() was called.
  void stop_if_cancelled() const;

  /// Waits until everything reported before has been passed on; throws as stop_if_cancelled(). For the work's thread.
  void settle();

  void cancel() { cancelled_ = true; }
  void finish();
  /// Waits until the work has ended or settles, at most that long. Returns whether the work has ended.
  bool wait(std::chrono::milliseconds at_most);
  /// Returns whether the work's thread waits in settle().
  bool settling();
  /// Ends the wait in settle().
  void delivered();
  /// Returns what was reported since the last call: for each pass only its last state.
  std::vector<Event> take();

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  std::condition_variable settled_;
  std::atomic<bool> cancelled_{false};
  bool finished_ = false;
  bool settling_ = false;
  bool changed_ = false;  // pass_ has changed since the last take()
  Event pass_;
  std::vector<Event> earlier_;
};

/// Runs `work` and rethrows its exceptions. While it runs, the calling thread calls `progress`, unless it is None, as
/// progress(pass, done, total), and runs the interpreter's signal handlers. If one of them raises, the work is
/// cancelled, and the exception goes on after the work has ended. From then on the calling thread calls `interrupt`
/// repeatedly until the work has ended; `interrupt` makes whatever the work waits for fail. Notices go to the logger
/// "weir". The caller holds the interpreter's lock; `work` must not touch a Python object. If the interpreter ends in
/// the meantime, the work is cancelled, and this function does not return.
void run_watched(const pybind11::object& progress, const std::function<void(Watch&)>& work,
                 const std::function<void()>& interrupt = {});

}  // namespace weir::python
