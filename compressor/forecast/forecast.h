// What a conversion will come to, before it is made: `weir convert --dry-run`. A small volume is converted as it is, of
// a larger one a sample (sample_plan.h), both by convert_volume itself in files without names (scratch_file_system.h),
// and the figures of the sample are scaled to the volume. Nothing else is modelled.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "compressor/conversion_control.h"
#include "compressor/conversion_options.h"
#include "compressor/forecast/spread.h"
#include "format/io/file_system.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Of all voxels that were converted, or of those that a scene shows.
struct ForecastError {
  bool lossless = false;
  std::optional<Expected> psnr_db;  ///< over the sample's range; none where lossless
  double rmse = 0;
  double max_abs = 0;
};

struct Forecast {
  bool whole = false;       ///< all of the volume was converted: the figures of the file and of its error are exact
  std::string not_sampled;  ///< why nothing was converted, so that there is neither error nor time; else empty
  std::uint64_t sampled_voxels = 0;
  std::int64_t places = 0;  ///< of the volume that were sampled
  std::size_t parts = 0;    ///< of the sample, for the spread; 0: too few places, or exact

  std::uint64_t volume_bytes = 0;  ///< of the volume as its file stores it, decoded
  double passes = 0;               ///< reads of the volume, some of them of parts
  std::uint64_t read_bytes = 0;    ///< in all of them

  std::string budget;        ///< the sidecar's budget.kind
  std::string encoding;      ///< "float", "fpn", ... "packed"; that of the sample
  bool exact_bytes = false;  ///< the file has exactly so many
  Expected file_bytes;
  std::uint64_t scratch_bytes = 0;  ///< at most, in unnamed or hidden files while it is converted
  std::uint64_t memory_bytes = 0;   ///< the most that the plan of the memory ceiling takes
  std::size_t threads = 0;
  bool on_device = false;

  ForecastError error;
  std::optional<ForecastError> shown;  ///< with a scene that shows something of what was converted
  std::uint64_t shown_voxels = 0;      ///< finite ones among those that were converted
  double value_low = 0;                ///< of all that was converted; NaN where no value is finite
  double value_high = 0;
  Sidecar::ConversionLoss loss;  ///< of the values that were converted, not scaled to the volume's

  double survey_s = 0;  ///< at the rates measured while the sample was converted
  double encode_s = 0;  ///< selection, encode pass, digest and flush
  double total_s() const { return survey_s + encode_s; }
};

/// Float32 bytes of the largest sample; a volume of up to twice that is converted whole.
inline constexpr std::uint64_t kForecastBytes = std::uint64_t{256} << 20U;

/// What convert_volume would do with the same arguments, checked as it checks them: throws its errors, those of values
/// that it refuses as far as the sample has them, and Error(io) where there is no room for the file. Writes nothing but
/// unnamed files, together of twice `most_bytes` or so at most.
Forecast forecast_conversion(VolumeSource& source, const ConversionOptions& options, const ConversionControl& control,
                             FileSystem& files, std::uint64_t most_bytes = kForecastBytes);

}  // namespace weir
