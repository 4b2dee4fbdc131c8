// Errors of what people derive from a volume, beside the error of its values: how |error| is distributed, the error of
// the gradient, and structural similarity. Streams both, as compare_volumes does.
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

  std::array<double, 4> quantiles{};  ///< of |error| over finite voxels, for kShares; error_histogram.h
  ErrorHistogram::Octaves octaves;    ///< of |error|
  GradientError gradient;             ///< per world unit
  Similarity similarity;
};

/// What `compared`, the result of compare_volumes for the same two with the same options, does not say. Reads both once
/// more. Results depend on neither block size nor threads. Throws as compare_volumes.
DerivedErrors derive_errors(VolumeSource& source, const NvdbGrid& grid, const Comparison& compared,
                            const CompareOptions& options);

/// DerivedErrors::gradient alone: what a sidecar certifies. The ranks of `team` divide the work, and all have the
/// result.
GradientError gradient_error(VolumeSource& source, const NvdbGrid& grid, const CompareOptions& options,
                             Team& team = no_team());

}  // namespace weir
