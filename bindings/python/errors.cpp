#include "bindings/python/errors.h"

#include <algorithm>
#include <exception>
#include <regex>

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
  PyErr_SetObject(type.ptr(), python_text(error.what()).ptr());
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

std::string keyword_text(const std::string& message) {
  static const std::regex option("( with -o)(?![A-Za-z0-9])|(^|[^-A-Za-z0-9_./])--([a-z]+(?:-[a-z]+)*)(?![A-Za-z0-9])");
  std::string text;
  auto rest = message.cbegin();
  for (auto at = std::sregex_iterator(message.begin(), message.end(), option); at != std::sregex_iterator(); ++at) {
    std::string name = at->str(3);
    std::replace(name.begin(), name.end(), '-', '_');
    text.append(rest, (*at)[0].first).append(at->str(2)).append(name);
    rest = (*at)[0].second;
  }
  return text.append(rest, message.cend());
}

py::str python_text(const std::string& message) {
  const std::string text = keyword_text(message);
  PyObject* decoded = PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<py::ssize_t>(text.size()));
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

}  // namespace weir::python
