// Handles the end of the interpreter while other threads are in calls of weir. The interpreter ends such a thread when
// the thread next takes the interpreter's lock, by unwinding its stack, and the program aborts if C++ code is unwound
// in this way. So running calls are stopped before the interpreter ends, and their threads wait for the end of the
// process.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <optional>

namespace weir::python {

/// Registers with the interpreter, while the module is being made: when the interpreter ends, stops all calls and waits
/// until they have ended, at most ten seconds.
void stop_calls_at_exit();

/// A call that works without the interpreter's lock; the lock is held when this object is made and destroyed. If
/// another thread is already ending the interpreter, no call begins: the calling thread waits for the end of the
/// process.
class CallUnderWay {
 public:
  /// `stop`, called with the lock held, makes the work end early. It is called repeatedly until the work has ended.
  explicit CallUnderWay(const std::function<void()>& stop = {});
  ~CallUnderWay();
  CallUnderWay(const CallUnderWay&) = delete;
  CallUnderWay& operator=(const CallUnderWay&) = delete;

  /// Runs `wait` without the lock, and rethrows its exceptions. Does not return if another thread ends the interpreter
  /// in the meantime. Only for the calling thread.
  void without_lock(const std::function<void()>& wait) const;
  /// Marks the work as ended. Any thread may call it, with or without the lock.
  void work_ended();

  struct State;

 private:
  std::shared_ptr<State> state_;
};

/// Runs `work` as a call, on the calling thread without the lock. Rethrows its exceptions.
void without_lock(const std::function<void()>& work);

/// Holds the interpreter's lock, in any thread. If the interpreter ends first, the constructor does not return: the
/// thread waits for the end of the process.
class Locked {
 public:
  Locked();

 private:
  std::optional<pybind11::gil_scoped_acquire> lock_;
};

/// Returns function(*arguments); the lock is held. Throws error_already_set; does not return if another thread ends the
/// interpreter in the meantime.
pybind11::object call_python(const pybind11::object& function, const pybind11::tuple& arguments);

/// Returns the module `name`; throws as call_python().
pybind11::object import_python(const char* name);

}  // namespace weir::python
