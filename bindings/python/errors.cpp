#include "bindings/python/errors.h"

#include <exception>

#include "bindings/python/interpreter_end.h"
#include "format/base/error.h"
#include "format/base/printable.h"
#include "format/process/fault.h"

namespace weir::python {

namespace py = pybind11;

namespace {

const char* class_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage:
      return "UsageError";
    case ErrorKind::input:
      return "InputError";
    case ErrorKind::budget:
      return "BudgetError";
    case ErrorKind::io:
      return "IoError";
    case ErrorKind::internal:
    case ErrorKind::interrupted:
      break;
  }
  return "Error";
}

py::str decoded_text(const std::string& text) {
  PyObject* decoded = PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<py::ssize_t>(text.size()));
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

void raise(const Error& error) {
  const py::object errors = import_python("weir.errors");
  py::object raised;
  if (const auto& failure = error.system_failure()) {
    raised = call_python(errors.attr("system_error"),
                         py::make_tuple(class_of(error.kind()), failure->errno_value, python_text(error.message()),
                                        decoded_text(failure->path)));
  } else {
    raised = call_python(errors.attr(class_of(error.kind())), py::make_tuple(python_text(error.message())));
  }
  PyErr_SetObject(py::type::of(raised).ptr(), raised.ptr());
}

}  // namespace

void translate_errors() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const Error& error) {
      raise(error);
    } catch (const std::exception& other) {
      if (!says_no_thread(other)) throw;  // pybind11 has an exception of Python for each type
      raise(fault_of(other));
    }
  });
}

py::str python_text(const Message& message) { return decoded_text(one_line_of_bytes(message.worded(key_wording))); }

}  // namespace weir::python
