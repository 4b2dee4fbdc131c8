// The end of the interpreter while other threads are in calls of weir. It ends such a thread where that next takes its
// lock, by unwinding the stack, and a program ends with an abort where C++ code is unwound so. Therefore calls under
// way are stopped before the interpreter ends, and their threads wait for the end of the process.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <memory>
#include <optional>

namespace weir::python {

/// For the module that is being made: stops all calls when the interpreter ends, and waits until they have ended, ten
/// seconds at most.
void stop_calls_at_exit();

/// A call whose work goes on without the interpreter's lock, which is held where this is made and destroyed. Where
/// another thread ends the interpreter already, no call begins: the calling thread waits for the end of the process.
class CallUnderWay {
 public:
  /// `stop`, called with the lock held, makes the work end early. It is called again and again until that has ended.
  explicit CallUnderWay(const std::function<void()>& stop = {});
  ~CallUnderWay();
  CallUnderWay(const CallUnderWay&) = delete;
  CallUnderWay& operator=(const CallUnderWay&) = delete;

  /// Runs `wait` without the lock, and rethrows what it throws. Does not return where another thread ends the
  /// interpreter meanwhile. For the calling thread.
  void without_lock(const std::function<void()>& wait) const;
  /// Says that the work has ended. For any thread, with or without the lock.
  void work_ended();

  struct State;

 private:
  std::shared_ptr<State> state_;
};

/// A call whose work is `work`, done by the calling thread without the lock. Rethrows what that throws.
void without_lock(const std::function<void()>& work);

/// Holds the interpreter's lock, in any thread. Is not made where the interpreter ends before: the thread waits then
/// for the end of the process.
class Locked {
 public:
  Locked();

 private:
  std::optional<pybind11::gil_scoped_acquire> lock_;
};

/// function(*arguments), with the lock held. Throws error_already_set; does not return where another thread ends the
/// interpreter meanwhile.
pybind11::object call_python(const pybind11::object& function, const pybind11::tuple& arguments);

/// The module `name`; as call_python.
pybind11::object import_python(const char* name);

}  // namespace weir::python
