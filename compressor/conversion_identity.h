// What decides the bytes of a conversion, as text, to recognise an interrupted one.
#pragma once

#include <map>
#include <string>

#include "compressor/conversion_options.h"
#include "compressor/resume/checkpoint.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Of the options of a command line, as Sidecar::Weir has them, those that change the volume's bytes: not memory,
/// threads and places.
std::map<std::string, std::string> deciding_options(std::map<std::string, std::string> options);

/// What decides which values a scene shows, and so where an error target is met: the file may change under its path.
std::string visible_values(const Scene& scene);

/// Of visible_values, for the sidecar (Sidecar::Visible::scene_digest); 32 hex digits.
std::string scene_digest(const Scene& scene);

/// Source (path, size, modification time, inodes and states of its files, dataset, type, extent), all of `options` that
/// has a say, and the program.
ConversionIdentity identify_conversion(const SourceInfo& source, const ConversionOptions& options);

}  // namespace weir
