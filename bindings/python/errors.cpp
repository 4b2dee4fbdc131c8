#include "bindings/python/errors.h"

#include <exception>

#include "format/base/error.h"

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

void raise(const Error& error) {
  const py::object type = py::module_::import("weir.errors").attr(class_of(error.kind()));
  PyErr_SetObject(type.ptr(), python_text(error.message()).ptr());
}

}  // namespace

void translate_errors() {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const Error& error) {
      raise(error);
    }
  });
}

py::str python_text(const Message& message) {
  const std::string text = message.worded(key_wording);
  PyObject* decoded = PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<py::ssize_t>(text.size()));
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

}  // namespace weir::python
