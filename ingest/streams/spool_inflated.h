// Unpacks a gzip or zlib stream of a file once into a spool file.
#pragma once

#include <cstdint>
#include <memory>

#include "ingest/files/input_file.h"
#include "ingest/source/source_options.h"

namespace weir {

/// The bytes of a file that hold one compressed stream.
struct PackedRange {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;  ///< offset + bytes <= the file's size
};

/// The wanted bytes of an unpacked stream.
struct UnpackedRange {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;  ///< > 0
  std::uint64_t end = 0;    ///< bytes of the whole unpacked stream, >= offset + bytes
};

/// Unpacks `packed` of `file` once, to its end, in bounded memory, and keeps `wanted` in a spool file. Throws
/// Error(input) if the stream is damaged, cut, or not exactly wanted.end bytes long, and what SpoolFile throws.
std::unique_ptr<InputFile> spool_inflated(InputFile& file, const PackedRange& packed, const UnpackedRange& wanted,
                                          const SourceOptions& options);

}  // namespace weir
