// Reads bytes of a remote file through a Python function.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>

#include "format/remote/byte_range.h"

namespace weir::python {

/// Returns a reader that calls `fetch` with a list of (offset, bytes) and takes as many objects, each with a buffer of
/// that length. Any thread may call and destroy it, without the interpreter's lock. It throws what `fetch` raises, and
/// Error(io) if `fetch` returns something else.
RangeReader python_range_reader(const pybind11::function& fetch);

/// Returns a function that calls `function`. Any thread may destroy it; its caller holds the interpreter's lock.
std::function<void()> python_call(const pybind11::function& function);

}  // namespace weir::python
