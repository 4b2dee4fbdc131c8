// A conversion that leaves nothing behind it.
#pragma once

#include "compressor/conversion_control.h"
#include "compressor/conversion_options.h"
#include "format/io/file_system.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct Trial {
  Sidecar sidecar;
  double survey_s = 0;
  double encode_s = 0;  ///< all the rest, the flush of the file to its device with it
};

/// Converts `source` as convert_volume does, in a ScratchFileSystem over `files`. Throws what that throws.
Trial run_trial(VolumeSource& source, ConversionOptions options, const ConversionControl& control, FileSystem& files);

}  // namespace weir
