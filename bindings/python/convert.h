// weir.convert: a volume, in a file or in memory, into a NanoVDB file and its sidecar.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>

#include "format/base/option_row.h"

namespace weir::python {

/// Converts the file at `source` to `output` (empty: beside it), options as of `weir convert`; the sidecar as JSON.
std::string convert_file(const std::string& source, const std::string& output, const GivenOptions& options,
                         const pybind11::object& progress);
/// The same of an array [z, y, x] of scalars named `type` in this machine's byte order, which is read where it is.
std::string convert_array(const pybind11::array& source, const std::string& type, const std::string& output,
                          const GivenOptions& options, const pybind11::object& progress);

}  // namespace weir::python
