// What a sidecar says of how its source was read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "format/base/option_row.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// What lies beside a volume.
struct InputRecord {
  std::string path;                ///< of the sidecar, be it there or not
  std::optional<Sidecar> sidecar;  ///< if it is the volume's own
  std::string unusable;            ///< why one that is there is none: "PATH: ...; the source is read without ..."
};

/// Throws nothing: what is wrong with the sidecar is `unusable`.
InputRecord read_input_record(const NvdbFile& file);

/// Sets extent, type, byte order and offset of raw files, whether it is a stack, dataset, index, component, level,
/// region, spacing, the value that stands for "no data" and whether such voxels are data in `options`, where they are
/// not `given`, to those that `recorded` has, if that is of a source of the format of `input`. Returns what was set, as
/// options, "--dataset /rho --index 3"; empty: nothing.
std::string take_recorded_input(const std::string& input, const InputRecord& recorded, const GivenOptions& given,
                                SourceOptions& options);

/// Where `recorded`, if it is of the format of `source`, was made of the file at the same path when it had another
/// time: what is different, to follow the source's path; else empty.
std::string changed_source_note(const InputRecord& recorded, const SourceInfo& source);

/// Where `recorded`, if it is of the format of `source`, has another dataset, index, component or spacing than
/// `source`: "was converted with --index 1, as a.nvdb.json records, and is compared with --index 0"; else empty.
std::string other_input_note(const InputRecord& recorded, const SourceInfo& source);

/// As --index takes it: "3,0".
std::string index_text(const std::vector<std::int64_t>& index);

}  // namespace weir
