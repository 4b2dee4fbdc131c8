// Work that a Python program waits for: it runs on a thread of its own without the interpreter's lock, while the
// calling thread, which alone runs Python code, hands on progress and looks for Ctrl-C.
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

/// What the work tells, and is told. Thread-safe.
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
  /// Throws Error(interrupted) where `cancel` was called.
  void stop_if_cancelled() const;

  /// Waits until all that was told before has been handed on; throws as stop_if_cancelled. For the work's thread.
  void settle();

  void cancel() { cancelled_ = true; }
  void finish();
  /// Waits for the end of the work, or until it settles, that long at most; whether it has ended.
  bool wait(std::chrono::milliseconds at_most);
  /// Whether the work's thread waits in settle().
  bool settling();
  /// Ends its wait.
  void delivered();
  /// What was told since the last call: of each pass the last state only.
  std::vector<Event> take();

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  std::condition_variable settled_;
  std::atomic<bool> cancelled_{false};
  bool finished_ = false;
  bool settling_ = false;
  bool changed_ = false;  // pass_ since the last take()
  Event pass_;
  std::vector<Event> earlier_;
};

/// Runs `work` and rethrows what it throws. `progress`, None or called as progress(pass, done, total), and the
/// interpreter's signal handlers run meanwhile; where one raises, the work is cancelled, and what was raised goes on
/// after it has ended. `interrupt` is called by the calling thread, again and again from then on until the work has
/// ended, and makes what the work waits for fail. Notices go to the logger "weir". The caller holds the interpreter's
/// lock; `work` must not touch a Python object. Where the interpreter ends meanwhile, the work is cancelled, and this
/// does not return.
void run_watched(const pybind11::object& progress, const std::function<void(Watch&)>& work,
                 const std::function<void()>& interrupt = {});

}  // namespace weir::python
