// Errors beyond those of the values themselves: the distribution of |error|, the error of the gradient, and the
// structural similarity. Streams the source and the file, as compare_volumes does.
#pragma once

#include <array>

#include "compressor/compare/compare.h"
#include "compressor/derived/error_histogram.h"
#include "compressor/derived/gradient_error.h"
#include "compressor/derived/similarity.h"
#include "compressor/team/team.h"
#include "format/nanovdb/nvdb_grid.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct DerivedErrors {
  static constexpr std::array<double, 4> kShares{0.5, 0.9, 0.99, 0.999};

  std::array<double, 4> quantiles{};  ///< quantiles kShares of |error| over finite voxels (error_histogram.h)
  ErrorHistogram::Octaves octaves;    ///< distribution of |error|
  GradientError gradient;             ///< per world unit
  Similarity similarity;
};

/// Finds the derived errors of `grid` against `source`. `compared` is the result of compare_volumes for the same two
/// with the same options. Reads both once more. Results depend on neither block size nor threads. Throws as
/// compare_volumes.
DerivedErrors derive_errors(VolumeSource& source, const NvdbGrid& grid, const Comparison& compared,
                            const CompareOptions& options);

/// Returns DerivedErrors::gradient alone, which a sidecar certifies. The ranks of `team` divide the work, and all get
/// the result.
GradientError gradient_error(VolumeSource& source, const NvdbGrid& grid, const CompareOptions& options,
                             Team& team = no_team());

}  // namespace weir
