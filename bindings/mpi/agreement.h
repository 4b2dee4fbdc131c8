// Whether the processes of a conversion were told the same.
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

/// What all processes of a conversion must be told alike, by name. Not times and numbers of the source's files: nodes
/// may see others of the same file, whose attributes they cache.
ConversionIdentity said_by_all(const SourceInfo& info, const ConversionOptions& options);

/// Of pieces of 4 KiB that are spread over each of these files, or the first 64 of them: a stale copy of a file may
/// have the size and the times of the file itself, but hardly its bytes. Throws Error(input) where one cannot be read.
Digest sampled_bytes(std::span<const FileState> files);

/// All ranks call it. Throws Error(usage), "WHERE: process 1 of 2 has --rate 4 where process 0 has --rate 2; ...", on
/// all of them where one says something else than the leading one; WHERE is that one's.
void require_alike(Team& team, const std::string& where, const ConversionIdentity& said);

}  // namespace weir
