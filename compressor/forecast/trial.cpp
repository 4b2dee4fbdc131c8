#include "compressor/forecast/trial.h"

#include <chrono>

#include "compressor/conversion.h"
#include "compressor/forecast/scratch_file_system.h"
#include "format/base/seconds_since.h"

namespace weir {

Trial run_trial(VolumeSource& source, ConversionOptions options, const ConversionControl& control, FileSystem& files) {
  options.resume = Resume::off;  // there is nothing to continue
  ScratchFileSystem scratch(files, options.output);
  const auto started = std::chrono::steady_clock::now();
  Trial trial;
  trial.sidecar = convert_volume(source, options, control, scratch);
  trial.survey_s = trial.sidecar.timing.survey_s;
  trial.encode_s = seconds_since(started) - trial.survey_s;
  return trial;
}

}  // namespace weir
