// The options of an input, as the command line gives them.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "format/base/message.h"
#include "format/base/scalar_type.h"
#include "ingest/files/input_file.h"
#include "ingest/source/component_choice.h"
#include "ingest/source/index_choice.h"
#include "ingest/source/levels.h"
#include "ingest/source/missing_chunks.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/upsampling.h"
#include "ingest/source/volume_region.h"

namespace weir {

struct SourceOptions {
  // Options of raw files, which have no header. They must agree with what the file's name says
  // (ingest/raw/raw_name.h).
  std::optional<Index3> extent;         ///< --dims, voxels; if absent, from the name
  std::optional<ScalarType> type;       ///< --type; if absent, from the name
  std::optional<bool> big_endian;       ///< --endian; if absent, from the name, else little
  std::optional<std::uint64_t> offset;  ///< --offset: bytes before the first value; default 0

  // Options of containers.
  /// --dataset: path or name inside the container; empty means the only one. Several names, one per line, and
  /// patterns are only for callers that make several volumes of them (ingest/series.h).
  std::string dataset;
  std::vector<std::int64_t> index;  ///< --index: position on each leading axis of an array of more than three
  /// --index if it is more than plain positions >= 0. Ignored unless `index` is empty. A caller that opens one volume
  /// takes no choice of several positions.
  std::vector<AxisChoice> index_choices;

  std::optional<ComponentChoice> component;  ///< --component: for an array of vectors or tensors

  /// --magnitude: the datasets that hold the components of a vector. The volume is the vector's length. Replaces
  /// `dataset`.
  std::vector<std::string> magnitude;

  // Options of levels of refinement.
  std::optional<std::int64_t> level;     ///< --level: finest level that is read, 0 = coarsest; default: the finest
  std::optional<Upsampling> upsampling;  ///< --upsample: how coarse cells fill fine voxels; default: constant
  Levels levels = Levels::composite;     ///< --levels
  /// With Levels::separate: the level that is this volume, 0 is the coarsest; absent if the file has one level.
  std::optional<std::int64_t> own_level;

  MissingChunks missing_chunks = MissingChunks::fill;  ///< --missing-chunks: for Zarr arrays and HDF5 datasets

  bool lists_damaged = false;  ///< lists include what cannot be opened, with its obstacle; else damage is an error

  bool stack = false;  ///< --stack: the path is a pattern, the volume many files stacked along z

  // Options of every format.
  std::optional<std::array<double, 3>> spacing;  ///< --spacing: world units per voxel, > 0; default: the file's, or 1
  std::optional<std::array<double, 3>> origin;   ///< --origin: world position of the centre of voxel (0, 0, 0)
  std::optional<StoredValue> missing;  ///< --missing: a value that means "no data", besides those that the file names
  bool keeps_missing = false;          ///< --missing-policy keep: values that mean "no data" are taken as data
  std::optional<VolumeRegion> roi;     ///< --roi, --ghost; if absent, the whole volume
  DirectIo direct_io = DirectIo::automatic;  ///< --direct-io

  // Resources for opening and reading.
  std::uint64_t memory = std::uint64_t{512} << 20U;  ///< bytes for the whole process; opening a source that needs
                                                     ///< more throws
  const std::atomic<bool>* cancel = nullptr;         ///< if set to true, unpacking ends with Error(interrupted)
  Notice notice;                ///< gets what only reading finds out, from any thread that reads; may be empty
  std::string spool_directory;  ///< directory on a disk to unpack compressed streams in; empty: the input's

  /// Adds the user's --missing and --missing-policy to `mapping`, which has what the file says about its values.
  void complete(ValueMapping& mapping) const {
    if (missing) mapping.missing.push_back(*missing);
    mapping.keeps_missing = keeps_missing;
  }
};

/// Throws Error(usage) if --index is given. For formats without axes that it could choose on.
void refuse_index(const std::string& path, const SourceOptions& options);

}  // namespace weir
