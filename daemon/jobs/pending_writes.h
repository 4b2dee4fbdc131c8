// What is to be written to the state file, in order, while that may be on a full disk.
#pragma once

#include <deque>
#include <functional>
#include <string>

#include "daemon/log/event_log.h"
#include "format/base/error.h"

namespace weir {

class PendingWrites {
 public:
  explicit PendingWrites(const EventLog& log) : log_(log) {}

  /// Runs `step`, after all before it; where it throws Error, keeps it for write(). CorruptDatabase goes through, here
  /// and in write().
  void add(std::function<void()> step);
  /// Runs what was kept.
  void write();
  bool empty() const { return steps_.empty(); }

  /// Why the state file cannot be written, one line; empty: it can.
  const std::string& fault() const { return fault_; }
  /// A step that can be done later failed: logged once.
  void log_fault(const Error& error);
  /// The state file was written: there is no fault, where nothing is kept.
  void clear_fault() {
    if (empty()) fault_.clear();
  }

 private:
  const EventLog& log_;
  std::deque<std::function<void()>> steps_;
  std::string fault_;
};

}  // namespace weir
