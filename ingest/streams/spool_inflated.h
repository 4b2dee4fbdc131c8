// A gzip or zlib stream in a file, unpacked once into a spool file.
#pragma once

#include <cstdint>
#include <memory>

#include "ingest/files/input_file.h"
#include "ingest/source/source_options.h"

namespace weir {

/// Bytes of a file that are one compressed stream.
struct PackedRange {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;  ///< offset + bytes <= the file's size
};

/// Where what is wanted lies in an unpacked stream.
struct UnpackedRange {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;  ///< > 0
  std::uint64_t end = 0;    ///< of the whole stream, >= offset + bytes
};

/// Unpacks `packed` of `file` once, to its end, in bounded memory, and keeps `wanted` in a spool file. Throws
/// Error(input) where the stream is damaged, cut, or not exactly wanted.end bytes long, and what SpoolFile throws.
std::unique_ptr<InputFile> spool_inflated(InputFile& file, const PackedRange& packed, const UnpackedRange& wanted,
                                          const SourceOptions& options);

}  // namespace weir
