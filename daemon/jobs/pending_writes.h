// Writes to the state file, kept in order while its disk is full.
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

  /// Runs `step` after all steps before it. If a step throws Error, keeps it and the following ones for write().
  /// CorruptDatabase passes through add() and write().
  void add(std::function<void()> step);
  /// Runs the steps that were kept.
  void write();
  bool empty() const { return steps_.empty(); }

  /// Returns one line that says why the state file cannot be written; empty if it can.
  const std::string& fault() const { return fault_; }
  /// Records a fault when a step fails that the caller can repeat later. A fault is logged once.
  void log_fault(const Error& error);
  /// Clears the fault after the state file was written, if no steps are kept.
  void clear_fault() {
    if (empty()) fault_.clear();
  }

 private:
  const EventLog& log_;
  std::deque<std::function<void()>> steps_;
  std::string fault_;
};

}  // namespace weir
