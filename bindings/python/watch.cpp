#include "bindings/python/watch.h"

#include <exception>
#include <thread>
#include <utility>

#include "bindings/python/errors.h"
#include "bindings/python/interpreter_end.h"
#include "format/base/error.h"
#include "format/process/float_mode.h"

namespace weir::python {

namespace py = pybind11;

namespace {

/// The longest time until Ctrl-C is noticed.
constexpr std::chrono::milliseconds kPause{50};

void deliver(Watch& watch, const py::object& progress) {
  for (const Watch::Event& event : watch.take()) {
    if (event.pass.empty()) {
      const char* const level = event.notice.is_remark() ? "info" : "warning";
      const py::object logger = call_python(import_python("logging").attr("getLogger"), py::make_tuple("weir"));
      call_python(logger.attr(level), py::make_tuple("%s", python_text(event.notice)));
    } else if (!progress.is_none()) {
      call_python(progress, py::make_tuple(event.pass, event.done, event.total));
    }
  }
}

// An exception of `interrupt`, for instance another KeyboardInterrupt, must not prevent joining the work's thread.
void interrupt_quietly(const std::function<void()>& interrupt) {
  try {
    if (interrupt) interrupt();
  } catch (const py::error_already_set&) {
    return;
  }
}

}  // namespace

void Watch::start(const std::string& pass, std::uint64_t total) {
  const std::lock_guard lock(mutex_);
  if (changed_) earlier_.push_back(pass_);
  pass_ = {pass, 0, total, {}};
  changed_ = true;
}

void Watch::advance(std::uint64_t done) {
  const std::lock_guard lock(mutex_);
  pass_.done = done < pass_.total ? done : pass_.total;
  changed_ = true;
}

void Watch::notice(const Message& line) {
  const std::lock_guard lock(mutex_);
  earlier_.push_back({{}, 0, 0, line});
}

void Watch::stop_if_cancelled() const {
  if (cancelled_) throw Error(ErrorKind::interrupted, "interrupted");
}

void Watch::settle() {
  std::unique_lock lock(mutex_);
  settling_ = true;
  ended_.notify_one();
  settled_.wait(lock, [this] { return !settling_; });
  lock.unlock();
  stop_if_cancelled();
}

void Watch::delivered() {
  const std::lock_guard lock(mutex_);
  settling_ = false;
  settled_.notify_one();
}

void Watch::finish() {
  const std::lock_guard lock(mutex_);
  finished_ = true;
  ended_.notify_one();
}

bool Watch::settling() {
  const std::lock_guard lock(mutex_);
  return settling_;
}

bool Watch::wait(std::chrono::milliseconds at_most) {
  std::unique_lock lock(mutex_);
  ended_.wait_for(lock, at_most, [this] { return finished_ || settling_; });
  return finished_;
}

std::vector<Watch::Event> Watch::take() {
  const std::lock_guard lock(mutex_);
  std::vector<Event> events = std::exchange(earlier_, {});
  if (std::exchange(changed_, false)) events.push_back(pass_);
  return events;
}

void run_watched(const py::object& progress, const std::function<void(Watch&)>& work,
                 const std::function<void()>& interrupt) {
  Watch watch;
  std::exception_ptr failure;
  std::exception_ptr raised;
  CallUnderWay call([&watch, interrupt] {
    watch.cancel();
    watch.delivered();
    interrupt_quietly(interrupt);
  });
  std::thread worker([&] {
    const FloatMode mode;
    try {
      work(watch);
    } catch (...) {
      failure = std::current_exception();
    }
    watch.finish();
    call.work_ended();
  });
  bool ended = false;
  while (!ended) {
    call.without_lock([&] { ended = watch.wait(kPause); });
    if (raised) {
      watch.delivered();
      if (!ended) interrupt_quietly(interrupt);
      continue;
    }
    const bool settling = watch.settling();  // read before the events are taken, so that they include everything before
                                             // the wait
    try {
      if (!ended && PyErr_CheckSignals() != 0) throw py::error_already_set();
      deliver(watch, progress);
    } catch (...) {
      raised = std::current_exception();
      watch.cancel();
    }
    if (settling || raised) watch.delivered();
  }
  worker.join();
  if (raised) std::rethrow_exception(raised);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace weir::python
