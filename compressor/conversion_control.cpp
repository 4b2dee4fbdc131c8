#include "compressor/conversion_control.h"

namespace weir {

StreamOptions stream_options(const ConversionControl& control) {
  StreamOptions options;
  options.cancel = control.cancel;
  options.trace = control.trace;
  options.progress = [&control](std::int64_t done, std::int64_t) {
    if (control.pass_advanced) control.pass_advanced(static_cast<std::uint64_t>(done) * sizeof(float));
  };
  return options;
}

Error interrupted_error() { return {ErrorKind::interrupted, "interrupted; nothing was written"}; }

void check_cancel(const ConversionControl& control) {
  if (control.cancel != nullptr && *control.cancel) throw interrupted_error();
}

void start_pass(const ConversionControl& control, const std::string& name, std::uint64_t voxels) {
  check_cancel(control);
  if (control.pass_started) control.pass_started(name, voxels * sizeof(float));
}

}  // namespace weir
