#include "bindings/python/interpreter_end.h"

#include <cxxabi.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <thread>
#include <vector>

namespace weir::python {

namespace py = pybind11;

struct CallUnderWay::State {
  std::function<void()> stop;
  std::atomic<bool> ended{false};
  pid_t process = ::getpid();  ///< a forked process has none of the threads of its calls
};

namespace {

/// The longest time that the end of the interpreter waits for calls; nearly all stop within a fraction of a second.
constexpr std::chrono::seconds kLongestWait{10};
constexpr std::chrono::milliseconds kBetweenLooks{5};

/// The thread that ends the interpreter; none before that.
std::atomic<std::thread::id>& ending_thread() {
  static std::atomic<std::thread::id> thread;
  return thread;
}

/// All running calls. The interpreter's lock guards this list.
std::vector<std::shared_ptr<CallUnderWay::State>>& calls_under_way() {
  static std::vector<std::shared_ptr<CallUnderWay::State>> calls;
  return calls;
}

bool another_thread_ends() {
  const std::thread::id thread = ending_thread();
  return thread != std::thread::id() && thread != std::this_thread::get_id();
}

[[noreturn]] void wait_for_the_process_to_end() {
  while (true) ::pause();
}

/// Returns call(), which takes the interpreter's lock. Must be directly around that call, so that nothing is unwound if
/// the interpreter ends the thread there.
template <class Call>
auto survived(const Call& call) {
  try {
    return call();
  } catch (const abi::__forced_unwind&) {
    wait_for_the_process_to_end();
  }
}

py::object owned(PyObject* found) {
  if (found == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(found);
}

void run_without_lock(const std::function<void()>& work) {
  std::exception_ptr failure;
  PyThreadState* const thread = PyEval_SaveThread();
  try {
    work();
  } catch (...) {
    failure = std::current_exception();
  }
  if (another_thread_ends()) wait_for_the_process_to_end();
  survived([&] { PyEval_RestoreThread(thread); });
  if (failure) std::rethrow_exception(failure);
}

std::vector<std::shared_ptr<CallUnderWay::State>> running_calls() {
  std::vector<std::shared_ptr<CallUnderWay::State>> running;
  std::ranges::copy_if(calls_under_way(), std::back_inserter(running),
                       [](const auto& call) { return !call->ended && call->process == ::getpid(); });
  return running;
}

void stop_all_calls() {
  ending_thread() = std::this_thread::get_id();
  const auto until = std::chrono::steady_clock::now() + kLongestWait;
  for (auto running = running_calls(); !running.empty(); running = running_calls()) {
    for (const auto& call : running) {
      if (!call->ended && call->stop) call->stop();  // stopping an earlier call may have let this one end
    }
    if (std::chrono::steady_clock::now() > until) return;
    {
      const py::gil_scoped_release unlocked;
      std::this_thread::sleep_for(kBetweenLooks);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

}  // namespace

void stop_calls_at_exit() {
  ending_thread() = std::thread::id();  // an embedded interpreter may have ended, and another one begun
  py::module_::import("atexit").attr("register")(py::cpp_function(stop_all_calls));
}

CallUnderWay::CallUnderWay(const std::function<void()>& stop) : state_(std::make_shared<State>()) {
  if (another_thread_ends()) run_without_lock([] {});
  state_->stop = stop;
  calls_under_way().push_back(state_);
}

CallUnderWay::~CallUnderWay() {
  state_->ended = true;
  std::erase(calls_under_way(), state_);
}

void CallUnderWay::without_lock(const std::function<void()>& wait) const { run_without_lock(wait); }

void CallUnderWay::work_ended() { state_->ended = true; }

void without_lock(const std::function<void()>& work) {
  CallUnderWay call;
  call.without_lock([&] {
    try {
      work();
    } catch (...) {
      call.work_ended();
      throw;
    }
    call.work_ended();
  });
}

Locked::Locked() {
  survived([&] { lock_.emplace(); });
}

py::object call_python(const py::object& function, const py::tuple& arguments) {
  return owned(survived([&] { return PyObject_CallObject(function.ptr(), arguments.ptr()); }));
}

py::object import_python(const char* name) {
  return owned(survived([&] { return PyImport_ImportModule(name); }));
}

}  // namespace weir::python
