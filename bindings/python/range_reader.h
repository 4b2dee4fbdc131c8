// Bytes of a remote file, by a function of Python.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "format/remote/byte_range.h"

namespace weir::python {

/// Calls `fetch` with a list of (offset, bytes), and takes as many objects with a buffer of that length each. May be
/// called and destroyed by any thread, without the interpreter's lock. Throws what `fetch` raises, and Error(io) where
/// it returns something else.
RangeReader python_range_reader(const pybind11::function& fetch);

/// Calls `function`. May be destroyed by any thread; its caller holds the interpreter's lock.
std::function<void()> python_call(const pybind11::function& function);

}  // namespace weir::python
