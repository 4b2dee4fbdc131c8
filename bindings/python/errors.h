// weir's errors as Python's: the classes of weir/errors.py, by kind, with messages that name keywords where the command
// line's name options.
#pragma once

#include <pybind11/pybind11.h>

#include "format/base/message.h"

namespace weir::python {

/// From here on an Error becomes an exception of weir.errors.
void translate_errors();

/// `message` with keywords for options ("max_error") as Python's text: paths in it may hold any bytes.
pybind11::str python_text(const Message& message);

}  // namespace weir::python
