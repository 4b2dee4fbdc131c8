// Finds what a conversion would refuse, without converting: output places, room on disk, values of a sample, and sizes
// that are too small for any file.
#pragma once

#include <cstdint>
#include <string>

#include "compressor/conversion_options.h"
#include "format/io/file_system.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// The directories that a conversion writes to.
class OutputPlaces {
 public:
  /// Throws what OutputFiles, WorkDirectory and require_lasting_output throw for options.output, options.work_dir and
  /// options.resume. All arguments must outlive the object.
  OutputPlaces(FileSystem& files, const ConversionOptions& options);

  /// Throws Error(io) if there is no room for a file of `file_bytes` and for `scratch_bytes` of work files.
  void require_room(std::uint64_t file_bytes, std::uint64_t scratch_bytes) const;

 private:
  void require_room_in(const std::string& directory, std::uint64_t bytes) const;

  FileSystem& files_;
  const ConversionOptions& options_;
  std::string directory_;
  std::string spill_directory_;
};

/// Throws Error(input) if the sample that `sidecar` describes has values that `options` refuse (refused_values.h).
void refuse_sampled_values(const ConversionOptions& options, const Sidecar& sidecar);

/// Throws Error(budget), because the requested `bytes` are fewer than the smallest tree takes: about `least` bytes.
[[noreturn]] void refuse_size(const ConversionOptions& options, std::uint64_t bytes, std::uint64_t least);

/// Throws Error(budget) if no file of a volume over `domain` can be as small as `bytes`.
void refuse_hopeless_size(const ConversionOptions& options, const Box& domain, std::uint64_t bytes);

}  // namespace weir
