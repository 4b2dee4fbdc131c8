// What a sweep measured, as CSV, as JSON and as a table for people.
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

/// What one method made of the volume at one rate.
struct SweepResult {
  std::string encoding;     ///< what the values are stored as: "packed", "zfp" or the sidecar's grid.type
  std::uint64_t bytes = 0;  ///< the file's size; of ZFP the stream's
  Certificate error;        ///< decoded values against the float32 source
  double seconds = 0;       ///< wall clock, from the first byte read to the last one on disk
  std::optional<std::uint64_t> leaves_kept;  ///< none for ZFP
  Sidecar::ConversionLoss loss{};            ///< of the source's values to float32, which the error does not count
};

struct SweepRow {
  std::string method;
  double rate = 0;  ///< dense float32 bytes / bytes asked
  std::uint64_t bytes_asked = 0;
  std::optional<SweepResult> result;  ///< none where the method cannot do it; `note` says why
  std::string note;                   ///< one line; may be empty
};

struct SweepReport {
  std::string source;  ///< as the user gave it
  std::string chosen;  ///< of the source: chosen_text()
  Index3 extent;       ///< voxels, after --roi
  std::size_t threads = 0;
  std::uint64_t memory = 0;  ///< the ceiling, bytes
  std::vector<SweepRow> rows;
  double total_s = 0;  ///< of the whole sweep
  std::uint64_t peak_rss_bytes = 0;

  double voxels() const { return static_cast<double>(volume(extent)); }
  double bits_per_voxel(const SweepResult& result) const { return 8 * static_cast<double>(result.bytes) / voxels(); }
  /// Dense float32 bytes per second, 10^9.
  double gb_per_s(const SweepResult& result) const { return 4 * voxels() / result.seconds / 1e9; }
};

/// "512 values rounded to float32, by up to 0.5"; empty where that is nothing, or far less than the error.
std::string loss_note(const SweepResult& result);

/// A header line and one line a row (RFC 4180, lines end in a newline alone); doubles read back bit-exact, what
/// a row has not is empty.
std::string csv_text(const SweepReport& report);

/// One object; what a row has not, and what is not finite, is null.
std::string json_text(const SweepReport& report);

/// Aligned columns; a row without a result has its note there.
std::string table_text(const SweepReport& report);

}  // namespace weir
