// weir.convert: a volume, in a file or in memory, into a NanoVDB file and its sidecar.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/base/option_row.h"

namespace weir::python {

/// Converts the volumes that `source` and the options name to `output` (empty: beside the source), with the options of
/// `weir convert`. Returns the sidecar of each volume as JSON. Throws Error(usage) for more than one volume if
/// `several` is false.
std::vector<std::string> convert_files(const std::string& source, const std::string& output,
                                       const GivenOptions& options, bool several, const pybind11::object& progress);
/// Converts an array [z, y, x] of scalars of the type `type` in this machine's byte order; reads it in place. `meaning`
/// may have "units", "long_name", "time" (a number and its units), and "axes", of x, y and z, each with "name",
/// "units", "coordinates" and "note".
std::string convert_array(const pybind11::array& source, const std::string& type, const std::string& output,
                          const GivenOptions& options, const pybind11::dict& meaning, const pybind11::object& progress);
/// Like convert_array(), for an array with values on a CUDA device, after the work queued in `stream` if it is given.
/// Axes z, y, x; strides in bytes.
std::string convert_device_array(std::uint64_t address, const std::array<std::int64_t, 3>& shape,
                                 const std::array<std::int64_t, 3>& strides, const std::string& type,
                                 const std::optional<std::uint64_t>& stream, const std::string& output,
                                 const GivenOptions& options, const pybind11::dict& meaning,
                                 const pybind11::object& progress);

}  // namespace weir::python
