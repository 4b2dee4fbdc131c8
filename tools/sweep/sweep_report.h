// The measurements of a sweep, as CSV, as JSON and as a table for people.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compressor/leaf/certificate.h"
#include "format/base/index.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// The result of one method at one rate.
struct SweepResult {
  std::string encoding;                      ///< how the values are stored: "packed", "zfp" or the sidecar's grid.type
  std::uint64_t bytes = 0;                   ///< size of the file; for ZFP of the stream
  Certificate error;                         ///< decoded values against the float32 source
  double seconds = 0;                        ///< wall clock, from the first byte read to the last byte on disk
  std::optional<std::uint64_t> leaves_kept;  ///< none for ZFP
  Sidecar::ConversionLoss loss{};            ///< from the source's values to float32; the error does not count it
};

struct SweepRow {
  std::string method;
  double rate = 0;  ///< dense float32 bytes / bytes asked
  std::uint64_t bytes_asked = 0;
  std::optional<SweepResult> result;  ///< nullopt if the method cannot reach the rate; `note` says why
  std::string note;                   ///< one line; may be empty
};

struct SweepReport {
  std::string source;  ///< path as the user gave it
  std::string chosen;  ///< chosen_text() of the source
  Index3 extent;       ///< voxels, after --roi
  std::size_t threads = 0;
  std::uint64_t memory = 0;  ///< the ceiling, bytes
  std::vector<SweepRow> rows;
  double total_s = 0;  ///< of the whole sweep
  std::uint64_t peak_rss_bytes = 0;

  double voxels() const { return static_cast<double>(volume(extent)); }
  double bits_per_voxel(const SweepResult& result) const { return 8 * static_cast<double>(result.bytes) / voxels(); }
  /// Throughput in 10^9 bytes of dense float32 per second.
  double gb_per_s(const SweepResult& result) const { return 4 * voxels() / result.seconds / 1e9; }
};

/// Returns "512 values rounded to float32, by up to 0.5"; empty if there is no loss or it is far below the error.
std::string loss_note(const SweepResult& result);

/// Returns a header line and one line per row (RFC 4180, but lines end in a newline alone). Doubles read back
/// bit-exact; missing figures are empty.
std::string csv_text(const SweepReport& report);

/// Returns one JSON object; figures that are missing or not finite are null.
std::string json_text(const SweepReport& report);

/// Returns aligned columns; a row without a result shows its note.
std::string table_text(const SweepReport& report);

}  // namespace weir
