// A conversion that leaves nothing behind.
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
  double encode_s = 0;  ///< seconds of all the rest, including the flush of the file to its disk
};

/// Converts `source` with convert_volume in a ScratchFileSystem over `files`. Throws as convert_volume.
Trial run_trial(VolumeSource& source, ConversionOptions options, const ConversionControl& control, FileSystem& files);

}  // namespace weir
