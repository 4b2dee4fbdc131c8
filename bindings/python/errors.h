// weir's errors as Python exceptions: the classes of weir/errors.py, by kind, with messages that name keywords instead
// of the command line's options.
#pragma once

#include <pybind11/pybind11.h>

#include "format/base/message.h"

namespace weir::python {

/// From this call on, an Error becomes an exception of weir.errors.
void translate_errors();

/// Returns `message` as Python's text, with keywords for options ("max_error"); paths in it may hold any bytes.
pybind11::str python_text(const Message& message);

}  // namespace weir::python
