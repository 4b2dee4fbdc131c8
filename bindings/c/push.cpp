#include <utility>

#include "bindings/c/open_push.h"
#include "bindings/c/status.h"
#include "format/process/fork_guard.h"
#include "gpu/packed/coder_choice.h"
#include "ingest/values/array_source.h"

using namespace weir;
using namespace weir::c;

namespace weir::c {

std::unique_ptr<weir_push> begin_push(const weir_volume* volume, const weir_convert_options* options,
                                      const char* output) {
  refuse_forked();  // before slabs are taken that the end could not convert
  SourceInfo info = array_info(read_volume(volume));
  const weir_convert_options given = options_or_defaults(options);
  auto made = std::make_unique<weir_push>(given);
  ConversionOptions conversion = read_options(given);
  info.mapping.keeps_missing = conversion.missing == MissingPolicy::keep;
  conversion.output = checked_output(output);
  keep_places(conversion);
  ConversionControl control = made->callbacks.control();
  made->coder =
      choose_coder(conversion.backend, conversion.encoding == Encoding::packed, conversion.memory, control.notice);
  control.coder = made->coder.get();
  made->notice = control.notice;
  made->memory = conversion.memory;
  made->volume = std::make_unique<PushedVolume>(std::move(info), conversion, control, *made->files);
  return made;
}

std::array<std::int64_t, 3> slab_stride(const PushedVolume& volume, const std::int64_t* stride) {
  if (stride == nullptr) return packed_stride(volume.info().extent, volume.info().type);
  return {stride[0], stride[1], stride[2]};
}

void push_host_slab(weir_push& push, std::int64_t z0, std::int64_t nz, const void* data,
                    const std::array<std::int64_t, 3>& stride) {
  push.callbacks.look_for_cancel();
  PushInFlight* in_flight = nullptr;
  {
    const std::lock_guard lock(push.mutex);
    in_flight = push.in_flight.get();
    if (in_flight == nullptr) push.filled = true;
  }
  if (in_flight == nullptr || !in_flight->add(z0, nz, data, stride)) push.volume->slab(z0, nz, data, stride);
}

void end_push(weir_push& push) {
  if (push.in_flight) push.in_flight->finish();
  VolumeSource* const whole = push.in_flight ? push.in_flight->whole() : nullptr;
  whole != nullptr ? push.volume->end(*whole) : push.volume->end();
}

}  // namespace weir::c

weir_status weir_push_begin(const weir_volume* volume, const weir_convert_options* options, const char* output,
                            weir_push** push, weir_error* error) {
  return guarded(error, [&] {
    required(push, "push");
    *push = begin_push(volume, options, output).release();
  });
}

weir_status weir_push_slab(weir_push* push, int64_t z0, int64_t nz, const void* data, const int64_t stride[3],
                           weir_error* error) {
  return guarded(error, [&] {
    weir_push& taken = *required(push, "push");
    push_host_slab(taken, z0, nz, data, slab_stride(*taken.volume, stride));
  });
}

weir_status weir_push_end(weir_push* push, weir_error* error) {
  return guarded(error, [&] { end_push(*required(push, "push")); });
}

void weir_push_free(weir_push* push) { delete push; }
