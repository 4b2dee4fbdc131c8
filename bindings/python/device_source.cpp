#include "bindings/python/device_source.h"

#include "format/base/error.h"

#ifdef WEIR_HAVE_CUDA
#include "bindings/cuda/device_array_source.h"
#include "bindings/cuda/resident_choice.h"
#include "compressor/push/resident_source.h"
#include "gpu/cuda/runtime/current_device.h"
#endif

namespace weir::python {

#ifdef WEIR_HAVE_CUDA
void wait_for_stream(const void* data, std::uint64_t stream) {
  const KeptDevice kept(device_of(data));
  check_cuda(cudaStreamSynchronize(reinterpret_cast<cudaStream_t>(stream)), "work before an array's conversion");
}

std::unique_ptr<VolumeSource> open_device_source(const DenseArray& array, const ConversionRequest& request,
                                                 const ConversionControl& control) {
  const int device = device_of(array.data);
  const KeptDevice kept(device);
  const SourceInfo info = array_info(array);
  const bool without_gaps = array.stride == packed_stride(array.extent, array.type);
  if (without_gaps && !request.source.roi && may_stay_on_device(info, control.coder, request.conversion.memory)) {
    const auto make = [&] {
      return open_resident(make_resident_volume(device, static_cast<const float*>(array.data), info.domain(),
                                                say_device_failure(control.notice)),
                           info);
    };
    if (auto resident = try_resident(control.notice, make)) return resident;
  }
  return open_device_array(array, device);
}
#else
namespace {

[[noreturn]] void refuse_device() {
  throw Error(ErrorKind::usage,
              "source lies on a CUDA device, and this weir was built without CUDA; copy it to a numpy array first");
}

}  // namespace

void wait_for_stream(const void* /*data*/, std::uint64_t /*stream*/) { refuse_device(); }

std::unique_ptr<VolumeSource> open_device_source(const DenseArray& /*array*/, const ConversionRequest& /*request*/,
                                                 const ConversionControl& /*control*/) {
  refuse_device();
}
#endif

}  // namespace weir::python
