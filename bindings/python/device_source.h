// An array in the memory of a CUDA device, for weir.convert.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "compressor/options/conversion_request.h"
#include "format/base/message.h"
#include "ingest/values/array_source.h"

namespace weir::python {

/// A source of `array`, whose data lie on a device, after the work queued in `stream` (a cudaStream_t as a number)
/// where one is given. Where the device may do the work of `request`, the values are coded where they are; what keeps
/// it from that is said to `notice`. Throws Error(usage) where this build or this machine has no device, or the address
/// is of none, and Error(io).
std::unique_ptr<VolumeSource> open_device_source(const DenseArray& array, std::optional<std::uint64_t> stream,
                                                 const ConversionRequest& request, const Notice& notice);

}  // namespace weir::python
