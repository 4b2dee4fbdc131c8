#include "daemon/jobs/pending_writes.h"

#include <utility>

#include "daemon/store/sqlite.h"

namespace weir {

void PendingWrites::add(std::function<void()> step) {
  steps_.push_back(std::move(step));
  write();
}

void PendingWrites::write() {
  if (steps_.empty()) return;  // without a step, nothing is known about the state file
  try {
    while (!steps_.empty()) {
      steps_.front()();
      steps_.pop_front();
    }
    fault_.clear();
  } catch (const CorruptDatabase&) {
    throw;
  } catch (const Error& error) {
    log_fault(error);
  }
}

void PendingWrites::log_fault(const Error& error) {
  if (fault_.empty()) log_.error("state-file-fault", {{"reason", error.what()}});
  fault_ = error.what();
}

}  // namespace weir
