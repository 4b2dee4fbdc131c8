// What a conversion would refuse, found without it: places, room, values of a sample, sizes below any file.
#pragma once

#include <cstdint>
#include <string>

#include "compressor/conversion_options.h"
#include "format/io/file_system.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Where a conversion writes.
class OutputPlaces {
 public:
  /// Throws what OutputFiles, WorkDirectory and require_lasting_output throw of options.output, options.work_dir and
  /// options.resume. All outlive the object.
  OutputPlaces(FileSystem& files, const ConversionOptions& options);

  /// Throws Error(io) where there is no room for a file of so many bytes and what lies beside it until it is done.
  void require_room(std::uint64_t file_bytes, std::uint64_t scratch_bytes) const;

 private:
  void require_room_in(const std::string& directory, std::uint64_t bytes) const;

  FileSystem& files_;
  const ConversionOptions& options_;
  std::string directory_;
  std::string spill_directory_;
};

/// Throws Error(input) where the sample that `sidecar` is of has values that `options` refuse (refused_values.h).
void refuse_sampled_values(const ConversionOptions& options, const Sidecar& sidecar);

/// Throws Error(budget): `bytes` are less than the smallest tree takes, which are about `least`.
[[noreturn]] void refuse_size(const ConversionOptions& options, std::uint64_t bytes, std::uint64_t least);

/// Throws Error(budget) where no file of a volume over `domain` has as few bytes.
void refuse_hopeless_size(const ConversionOptions& options, const Box& domain, std::uint64_t bytes);

}  // namespace weir
