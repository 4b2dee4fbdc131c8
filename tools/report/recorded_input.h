// What a sidecar says of how its source was read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "format/base/option_row.h"
#include "format/nanovdb/nvdb_file.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// "PATH: ...; the source is read without what it records" where a sidecar lies beside `file` and cannot be read or is
/// of another volume; else empty.
std::string unusable_record_note(const NvdbFile& file);

/// Sets extent, type, byte order and offset of raw files, whether it is a stack, dataset, index, component, level,
/// region, spacing, the value that stands for "no data" and whether such voxels are data in `options`, where they are
/// not `given`, to those that the sidecar beside `file` records, if it is this file's own and of a source of the format
/// of `input`; a sidecar that cannot be read says nothing. Returns what was set, as options,
/// "--dataset /rho --index 3"; empty: nothing.
std::string take_recorded_input(const std::string& input, const NvdbFile& file, const GivenOptions& given,
                                SourceOptions& options);

/// Where the sidecar beside `file`, if it is this file's own and of the format of `source`, was made of the file
/// at the same path when it had another time: what is different, to follow the source's path; else empty.
std::string changed_source_note(const NvdbFile& file, const SourceInfo& source);

/// Where the sidecar beside `file`, if it is this file's own and of the format of `source`, records another dataset,
/// index, component or spacing than `source` has: "was converted with --index 1, as a.nvdb.json records, and is
/// compared with
/// --index 0"; else empty.
std::string other_input_note(const NvdbFile& file, const SourceInfo& source);

/// As --index takes it: "3,0".
std::string index_text(const std::vector<std::int64_t>& index);

}  // namespace weir
