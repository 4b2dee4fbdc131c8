// Everything that decides a conversion's bytes, as text. By it an interrupted conversion is recognised.
#pragma once

#include <map>
#include <string>

#include "compressor/conversion_options.h"
#include "compressor/resume/checkpoint.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns the command-line `options` (as in Sidecar::Weir) without options that leave the volume's bytes as they are,
/// for example memory, threads and paths.
std::map<std::string, std::string> deciding_options(std::map<std::string, std::string> options);

/// Returns, as text, the parts of `scene` that decide which values it shows, and so where an error target is met. The
/// scene's path alone does not tell, because the scene file may change.
std::string visible_values(const Scene& scene);

/// Returns the digest of visible_values() as 32 hex digits, for the sidecar (Sidecar::Visible::scene_digest).
std::string scene_digest(const Scene& scene);

/// Returns the identity of a conversion: the source (path, size, modification time, inodes and states of its files,
/// dataset, type, extent), every option that decides bytes, and the program's version and commit.
ConversionIdentity identify_conversion(const SourceInfo& source, const ConversionOptions& options);

}  // namespace weir
