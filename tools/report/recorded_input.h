// Reads from a sidecar how its source was read.
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

/// The sidecar that lies beside a volume.
struct InputRecord {
  std::string path;                ///< path of the sidecar, whether or not it exists
  std::optional<Sidecar> sidecar;  ///< the sidecar, if it belongs to the volume
  std::string unusable;            ///< why an existing sidecar is not used: "PATH: ...; the source is read without ..."
};

/// Reads the sidecar of `file`. Throws nothing: a fault of the sidecar is in `unusable`.
InputRecord read_input_record(const NvdbFile& file);

/// Fills options that are not `given` from `recorded`, if its source has the format of `input`: extent, type, byte
/// order and offset of raw files, stack, dataset, index, component, level, region, spacing, the "no data" value and
/// whether such voxels are data. Returns the options that were set, "--dataset /rho --index 3"; empty: none.
std::string take_recorded_input(const std::string& input, const InputRecord& recorded, const GivenOptions& given,
                                SourceOptions& options);

/// Returns what changed in the source file since the volume was made, if `recorded` names the same path and format but
/// another time; the text follows the source's path. Otherwise empty.
std::string changed_source_note(const InputRecord& recorded, const SourceInfo& source);

/// Returns how the dataset, index, component or spacing of `recorded` differs from `source`, if both have the same
/// format: "was converted with --index 1, as a.nvdb.json records, and is compared with --index 0"; otherwise empty.
std::string other_input_note(const InputRecord& recorded, const SourceInfo& source);

/// Returns `index` as --index takes it: "3,0".
std::string index_text(const std::vector<std::int64_t>& index);

}  // namespace weir
