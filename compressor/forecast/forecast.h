// Forecasts a conversion for `weir convert --dry-run`. convert_volume itself converts a small volume whole, or a sample
// (sample_plan.h) of a larger one, into files without names (scratch_file_system.h). The figures of the sample are
// scaled to the volume. Nothing else is modelled.
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

/// The error of all voxels that were converted, or of those that a scene shows.
struct ForecastError {
  bool lossless = false;
  std::optional<Expected> psnr_db;  ///< over the sample's range; unset if lossless
  double rmse = 0;
  double max_abs = 0;
};

struct Forecast {
  bool whole = false;       ///< the whole volume was converted: the figures of the file and of its error are exact
  std::string not_sampled;  ///< why nothing was converted (error and times are then not set); otherwise empty
  std::uint64_t sampled_voxels = 0;
  std::int64_t places = 0;  ///< number of places of the volume that were sampled
  std::size_t parts = 0;    ///< parts of the sample, for the spread; 0 if there are too few places, or if exact

  std::uint64_t volume_bytes = 0;  ///< bytes of the decoded volume in the type that its file stores
  double passes = 0;               ///< number of reads of the volume; reads of parts count as fractions
  std::uint64_t read_bytes = 0;    ///< bytes of all passes together

  std::string budget;        ///< the sidecar's budget.kind
  std::string encoding;      ///< encoding of the sample: "float", "fpn", ... "packed"
  bool exact_bytes = false;  ///< the file will have exactly `file_bytes`
  Expected file_bytes;
  std::uint64_t scratch_bytes = 0;  ///< most bytes in unnamed or hidden files during the conversion
  std::uint64_t memory_bytes = 0;   ///< most bytes that the memory plan under the ceiling takes
  std::size_t threads = 0;
  bool on_device = false;

  ForecastError error;
  std::optional<ForecastError> shown;  ///< set if a scene shows some of the converted voxels
  std::uint64_t shown_voxels = 0;      ///< finite converted voxels that the scene shows
  double value_low = 0;                ///< lowest converted value; NaN if no value is finite
  double value_high = 0;
  Sidecar::ConversionLoss loss;  ///< loss of the converted values, not scaled to the volume

  double survey_s = 0;  ///< seconds, at the rates measured while the sample was converted
  double encode_s = 0;  ///< selection, encode pass, digest and flush
  double total_s() const { return survey_s + encode_s; }
};

/// Float32 bytes of the largest sample. A volume of up to twice this size is converted whole.
inline constexpr std::uint64_t kForecastBytes = std::uint64_t{256} << 20U;

/// Returns what convert_volume would do with the same arguments. Throws the errors of convert_volume (for refused
/// values only if the sample has such values), and Error(io) if there is no room for the file. Writes only unnamed
/// files, together at most about twice `most_bytes`.
Forecast forecast_conversion(VolumeSource& source, const ConversionOptions& options, const ConversionControl& control,
                             FileSystem& files, std::uint64_t most_bytes = kForecastBytes);

}  // namespace weir
