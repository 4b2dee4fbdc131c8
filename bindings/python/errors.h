// weir's errors as Python's: the classes of weir/errors.py, by kind, with messages that name keywords where the command
// line's name options.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace weir::python {

/// From here on an Error becomes an exception of weir.errors.
void translate_errors();

/// `message` with "--max-error" as "max_error" and without " with -o".
std::string keyword_text(const std::string& message);
/// keyword_text as Python's text: paths in it may hold any bytes.
pybind11::str python_text(const std::string& message);

}  // namespace weir::python
