// weir.convert: a volume, in a file or in memory, into a NanoVDB file and its sidecar.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "format/base/option_row.h"

namespace weir::python {

/// Converts what `source` and the options name to `output` (empty: beside it), options as of `weir convert`; the
/// sidecar of each volume as JSON. Where not `several`, Error(usage) is thrown for more than one.
std::vector<std::string> convert_files(const std::string& source, const std::string& output,
                                       const GivenOptions& options, bool several, const pybind11::object& progress);
/// Converts an array [z, y, x] of scalars named `type` in this machine's byte order, which is read where it is.
/// `meaning` may have "units", "long_name", "time" (a number and its units), and "axes", of x, y and z, each with
/// "name", "units", "coordinates" and "note".
std::string convert_array(const pybind11::array& source, const std::string& type, const std::string& output,
                          const GivenOptions& options, const pybind11::dict& meaning, const pybind11::object& progress);

}  // namespace weir::python
