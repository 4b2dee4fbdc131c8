// Checks that all processes of a conversion were given the same arguments.
#pragma once

#include <span>
#include <string>

#include "compressor/conversion_options.h"
#include "compressor/resume/checkpoint.h"
#include "compressor/team/team.h"
#include "format/io/digest.h"
#include "ingest/files/file_state.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns, by name, the values that all processes of a conversion must share. Times and numbers of the source's files
/// are left out, because nodes cache file attributes and may see different ones.
ConversionIdentity said_by_all(const SourceInfo& info, const ConversionOptions& options);

/// Returns a digest of pieces of 4 KiB that are spread over each of `files`, or over the first 64 of them. A stale copy
/// of a file may have the file's size and times, but hardly its bytes. Throws Error(input) if a file cannot be read.
Digest sampled_bytes(std::span<const FileState> files);

/// Compares `said` on all ranks; all ranks call it. If one differs from the leading rank, throws Error(usage) on all,
/// "WHERE: process 1 of 2 has --rate 4 where process 0 has --rate 2; ..."; WHERE is that of the rank that differs.
void require_alike(Team& team, const std::string& where, const ConversionIdentity& said);

}  // namespace weir
