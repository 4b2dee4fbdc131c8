// What the command line says about an input.
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
  // Of raw files, which say nothing themselves. What the name says too (ingest/raw/raw_name.h) must agree.
  std::optional<Index3> extent;         ///< --dims, voxels; from the name where absent
  std::optional<ScalarType> type;       ///< --type; from the name where absent
  std::optional<bool> big_endian;       ///< --endian; from the name where absent, else little
  std::optional<std::uint64_t> offset;  ///< --offset: bytes before the first value; default 0

  // Of containers.
  /// --dataset: path or name inside the container; empty: the only one. Several, one on each line, and patterns are for
  /// who makes several volumes of them (ingest/series.h).
  std::string dataset;
  std::vector<std::int64_t> index;  ///< --index: position on each leading axis of an array of more than three
  /// --index where it says more than positions from 0 on; counts where `index` is empty. Who opens one volume takes no
  /// choice of several.
  std::vector<AxisChoice> index_choices;

  std::optional<ComponentChoice> component;  ///< --component: of an array of vectors or tensors

  /// --magnitude: the datasets whose values are the components of the vectors whose length is the volume; in place of
  /// `dataset`.
  std::vector<std::string> magnitude;

  // Of levels of refinement.
  std::optional<std::int64_t> level;     ///< --level: the finest one that is read, 0 the coarsest; the finest there is
  std::optional<Upsampling> upsampling;  ///< --upsample: of what only coarser levels have; constant
  Levels levels = Levels::composite;     ///< --levels
  /// Of Levels::separate the one that is this volume, 0 the coarsest; none where the file has one level.
  std::optional<std::int64_t> own_level;

  MissingChunks missing_chunks = MissingChunks::fill;  ///< --missing-chunks: of Zarr arrays and HDF5 datasets

  bool lists_damaged = false;  ///< a list has what cannot be opened, with its obstacle; else damage is an error

  bool stack = false;  ///< --stack: the path is a pattern, the volume many files on top of each other along z

  // Of every format.
  std::optional<std::array<double, 3>> spacing;  ///< --spacing: world units per voxel, > 0; the file's, else 1
  std::optional<std::array<double, 3>> origin;   ///< --origin: of the centre of voxel (0, 0, 0)
  std::optional<StoredValue> missing;            ///< --missing: stands for "no data", besides what the file says
  bool keeps_missing = false;                    ///< --missing-policy keep: what stands for "no data" is data
  std::optional<VolumeRegion> roi;               ///< --roi, --ghost; the whole volume where absent
  DirectIo direct_io = DirectIo::automatic;      ///< --direct-io

  // What opening and reading may use.
  std::uint64_t memory = std::uint64_t{512} << 20U;  ///< bytes, the whole process; a source that cannot do with less
                                                     ///< says so when it is opened
  const std::atomic<bool>* cancel = nullptr;         ///< ends unpacking with Error(interrupted)
  Notice notice;                ///< gets what only reading shows, of any thread that reads; may be empty
  std::string spool_directory;  ///< on a disk: where compressed streams are unpacked; empty: the input's directory

  /// Adds to what the file says of its values what the user says.
  void complete(ValueMapping& mapping) const {
    if (missing) mapping.missing.push_back(*missing);
    mapping.keeps_missing = keeps_missing;
  }
};

/// Throws Error(usage) where --index is given: for formats in which there is nothing that it could choose.
void refuse_index(const std::string& path, const SourceOptions& options);

}  // namespace weir
