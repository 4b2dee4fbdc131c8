// A synthetic volume as a mapped file, for benchmarks of code that reads it.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "compressor/conversion.h"
#include "format/base/text.h"
#include "format/nanovdb/nvdb_file.h"
#include "ingest/synthetic/synthetic.h"

namespace weir {

/// Returns a volume of `kind`, with WEIR_BENCH_DIM voxels along an edge (default 256), converted at `rate`. The file's
/// name is removed at once; the mapping stays. Throws as convert_volume().
inline NvdbFile converted_sample(const std::string& kind, Encoding encoding, double rate) {
  const char* text = std::getenv("WEIR_BENCH_DIM");
  const std::int64_t dim = text != nullptr ? parse_int(text).value_or(256) : 256;
  const auto source = open_synthetic(kind, {{dim, dim, dim}, 1});
  ConversionOptions options;
  options.output = (std::filesystem::temp_directory_path() / cat("weir_bench_", ::getpid(), ".nvdb")).string();
  options.encoding = encoding;
  options.budget = {.kind = Budget::Kind::rate, .rate = rate};
  const auto files = make_posix_file_system();
  convert_volume(*source, options, {}, *files);
  NvdbFile file(options.output);
  std::filesystem::remove(options.output);
  std::filesystem::remove(sidecar_path(options.output));
  return file;
}

}  // namespace weir
