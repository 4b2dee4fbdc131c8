#include "bindings/python/device_source.h"

#include "format/base/error.h"

#ifdef WEIR_HAVE_CUDA
#include <algorithm>

#include "bindings/cuda/device_array_source.h"
#include "compressor/push/resident_source.h"
#include "format/process/process_memory.h"
#include "gpu/cuda/encode/resident_volume.h"
#include "gpu/cuda/runtime/current_device.h"
#include "gpu/packed/coder_choice.h"
#endif

namespace weir::python {

#ifdef WEIR_HAVE_CUDA
namespace {

bool may_be_coded_in_place(const DenseArray& array, const SourceInfo& info, const ConversionRequest& request) {
  const ConversionOptions& options = request.conversion;
  const Index3& e = array.extent;
  return !request.source.roi && options.encoding == Encoding::packed && options.backend != CoderChoice::cpu &&
         options.memory >= resident_bytes() + kLeastMemoryOfDevice && array.type == ScalarType::float32 &&
         array.stride == packed_stride(e, array.type) && info.values_as_stored() && !info.mapping.marks_missing() &&
         std::max({e.x, e.y, e.z}) <= kLongestAxis;
}

}  // namespace

std::unique_ptr<VolumeSource> open_device_source(const DenseArray& array, std::optional<std::uint64_t> stream,
                                                 const ConversionRequest& request, const Notice& notice) {
  const int device = device_of(array.data);
  const KeptDevice kept(device);
  if (stream) {
    check_cuda(cudaStreamSynchronize(reinterpret_cast<cudaStream_t>(*stream)), "work before an array's conversion");
  }
  const SourceInfo info = array_info(array);
  if (may_be_coded_in_place(array, info, request)) {
    try {
      return open_resident(make_resident_volume(device, static_cast<const float*>(array.data), info.domain(),
                                                say_device_failure(notice)),
                           info);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::io) throw;
      say_device_failure(notice)(error);
    }
  }
  return open_device_array(array, device);
}
#else
std::unique_ptr<VolumeSource> open_device_source(const DenseArray& /*array*/, std::optional<std::uint64_t> /*stream*/,
                                                 const ConversionRequest& /*request*/, const Notice& /*notice*/) {
  throw Error(ErrorKind::usage,
              "source lies on a CUDA device, and this weir was built without CUDA; copy it to a numpy array first");
}
#endif

}  // namespace weir::python
