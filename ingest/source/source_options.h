// What the command line says about an input.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "format/base/scalar_type.h"
#include "ingest/files/input_file.h"
#include "ingest/source/stored_value.h"

namespace weir {

struct SourceOptions {
  // Of raw files, which say nothing themselves. What the name says too (ingest/raw/raw_name.h) must agree.
  std::optional<Index3> extent;         ///< --dims, voxels; from the name where absent
  std::optional<ScalarType> type;       ///< --type; from the name where absent
  std::optional<bool> big_endian;       ///< --endian; from the name where absent, else little
  std::optional<std::uint64_t> offset;  ///< --offset: bytes before the first value; default 0

  // Of containers.
  std::string dataset;  ///< --dataset: path or name inside the container; empty: the only one
  /// --index: position on each leading axis of an array of more than three; kEveryIndex (ingest/series.h) is
  /// for who makes several volumes of them.
  std::vector<std::int64_t> index;  ///< --index: position on each leading axis of an array of more than three

  bool stack = false;  ///< --stack: the path is a pattern, the volume many files on top of each other along z

  // Of every format.
  std::optional<std::array<double, 3>> spacing;  ///< --spacing: world units per voxel, > 0; the file's, else 1
  std::optional<std::array<double, 3>> origin;   ///< --origin: world position of index (0, 0, 0); the file's, else 0
  std::optional<StoredValue> missing;            ///< --missing: stands for "no data", besides what the file says
  std::optional<Box> roi;                        ///< --roi: index space, half open; the whole volume where absent
  DirectIo direct_io = DirectIo::automatic;      ///< --direct-io

  // What opening and reading may use.
  std::uint64_t memory = std::uint64_t{512} << 20U;  ///< bytes, the whole process; a source that cannot do with less
                                                     ///< says so when it is opened
  const std::atomic<bool>* cancel = nullptr;         ///< ends unpacking with Error(interrupted)
  std::string spool_directory;  ///< on a disk: where compressed streams are unpacked; empty: the input's directory
};

}  // namespace weir
