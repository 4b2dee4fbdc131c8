// An array in the memory of a CUDA device, for weir.convert.
#pragma once

#include <cstdint>
#include <memory>

#include "compressor/conversion_control.h"
#include "compressor/options/conversion_request.h"
#include "ingest/values/array_source.h"

namespace weir::python {

/// Waits for the work queued in `stream` (a cudaStream_t as a number) of the device that holds `data`. Call it on the
/// program's own thread, because stream 2 is different in each thread. Throws as open_device_source().
void wait_for_stream(const void* data, std::uint64_t stream);

/// Returns a source of `array`; its data lie on a device and are complete. If the device does the work of `request`,
/// the data are encoded in place; control.notice gets the reason if they cannot be. Throws Error(usage) if this build
/// or this machine has no device, or if the address is not of a device, and Error(io).
std::unique_ptr<VolumeSource> open_device_source(const DenseArray& array, const ConversionRequest& request,
                                                 const ConversionControl& control);

}  // namespace weir::python
