// The certificate of a conversion: what its sidecar says about the source, the file and the error between the two.
#pragma once

#include <string>

#include "compressor/conversion_options.h"
#include "compressor/encode/encode_attempts.h"
#include "compressor/select/leaf_reach.h"
#include "compressor/survey/background.h"
#include "compressor/survey/survey_figures.h"
#include "format/nanovdb/grid_head.h"
#include "format/sidecar/sidecar.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns the grid's name for a volume that its file calls `dataset`. A `dataset` of at most kMaxGridNameBytes of
/// UTF-8, which is all that a sidecar can hold, is the name. Otherwise its part after the last slash is the name if
/// that fits, else "density".
std::string grid_name(const std::string& dataset);

/// Returns the absolute path, without symbolic links, of the file or directory at info.path. If info.path is a
/// pattern, returns the path of the first file that it names. Empty if the volume lies in no file.
std::string real_path_of(const SourceInfo& info);

/// Returns a sidecar with everything that is known after the survey, except the source's digest.
Sidecar describe_source(const SourceInfo& info, const Survey& survey, const ConversionOptions& options);

/// Adds grid, background, budget, selection, errors and macrocells of the encoded file to `sidecar`. `shown` is what
/// options.scene shows.
void describe_file(Sidecar& sidecar, const SourceInfo& info, const Survey& survey, const ConversionOptions& options,
                   const Background& background, const GridHead& head, const EncodedFile& encoded, const Shown& shown);

}  // namespace weir
