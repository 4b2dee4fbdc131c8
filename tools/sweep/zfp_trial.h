// One volume through ZFP and back, streamed as a conversion streams it: how long it
// takes, and what is lost.
#pragma once

#include <cstdint>
#include <string>

#include "compressor/conversion.h"
#include "compressor/leaf/certificate.h"
#include "format/io/file_system.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct ZfpTrialOptions {
  unsigned block_bits = 0;   ///< see zfp_block_bits
  std::uint64_t memory = 0;  ///< bytes, the whole process
  std::string directory;     ///< for the stream, which has no name and goes with the process
};

struct ZfpTrial {
  std::uint64_t bytes = 0;              ///< of the volume as one stream without a header
  double seconds = 0;                   ///< reading, compressing, writing and flushing
  std::uint64_t nonfinite = 0;          ///< voxels of the source; where there are any, nothing else is known
  std::uint64_t nonfinite_decoded = 0;  ///< voxels that come back so; in no sum of the error
  Certificate error;
  ConversionLoss loss;  ///< of the source's values to float32
};

/// Compresses and writes `source` in one pass, then reads both again to compare. Results depend on neither
/// memory nor threads: squared errors are summed exactly. Throws what reading and writing throw, Error(usage)
/// naming a sufficient --memory, Error(interrupted) when cancelled.
ZfpTrial try_zfp(VolumeSource& source, const ZfpTrialOptions& options, const ConversionControl& control,
                 FileSystem& files);

}  // namespace weir
