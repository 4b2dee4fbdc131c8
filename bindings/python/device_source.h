// An array in the memory of a CUDA device, for weir.convert.
#pragma once

#include <cstdint>
#include <memory>

#include "compressor/conversion_control.h"
#include "compressor/options/conversion_request.h"
#include "ingest/values/array_source.h"

namespace weir::python {

/// Waits for the work queued in `stream` (a cudaStream_t as a number) of the device that `data` lie on. The calling
/// thread is to be the program's, since stream 2 is each thread's own. Throws as open_device_source.
void wait_for_stream(const void* data, std::uint64_t stream);

/// A source of `array`, whose data lie on a device and have been computed. Where the device does the work of `request`,
/// they are coded where they are; what keeps it from that is said to control.notice. Throws Error(usage) where this
/// build or this machine has no device, or the address is of none, and Error(io).
std::unique_ptr<VolumeSource> open_device_source(const DenseArray& array, const ConversionRequest& request,
                                                 const ConversionControl& control);

}  // namespace weir::python
