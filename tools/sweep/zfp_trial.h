// Compresses one volume with ZFP and decompresses it, streamed like a conversion. Measures the time and the error.
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
  std::string directory;     ///< for the stream's file, which has no name and vanishes with the process
};

struct ZfpTrial {
  std::uint64_t bytes = 0;              ///< size of the volume as one stream without a header
  double seconds = 0;                   ///< reading, compressing, writing and flushing
  std::uint64_t nonfinite = 0;          ///< non-finite voxels of the source; if there are any, no other figure is known
  std::uint64_t nonfinite_decoded = 0;  ///< voxels that decode to non-finite values; not in the error sums
  Certificate error;
  ConversionLoss loss;  ///< of the source's values to float32
};

/// Compresses and writes `source` in one pass, then reads source and stream again to compare them. Results depend on
/// neither memory nor threads, because squared errors are summed exactly. Throws what reading and writing throw,
/// Error(usage) naming a sufficient --memory, Error(interrupted) when cancelled.
ZfpTrial try_zfp(VolumeSource& source, const ZfpTrialOptions& options, const ConversionControl& control,
                 FileSystem& files);

}  // namespace weir
