// The certificate of a conversion: what its sidecar says of the source, of the file
// and of the error between the two.
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

/// The name of the grid of a volume that its file calls `dataset`: that, or where it has more than kMaxGridNameBytes or
/// is no UTF-8, which no sidecar can hold, its part after the last slash, or "density".
std::string grid_name(const std::string& dataset);

/// Of the file or directory at info.path, absolute and without symbolic links; of files that a pattern names that of
/// the first one. Empty where the volume lies in no file.
std::string real_path_of(const SourceInfo& info);

/// A sidecar with all that is known once the volume is surveyed, but for the source's digest.
Sidecar describe_source(const SourceInfo& info, const Survey& survey, const ConversionOptions& options);

/// Adds grid, background, budget, selection, errors and macrocells of the encoded file. `shown` is for options.scene.
void describe_file(Sidecar& sidecar, const SourceInfo& info, const Survey& survey, const ConversionOptions& options,
                   const Background& background, const GridHead& head, const EncodedFile& encoded, const Shown& shown);

}  // namespace weir
