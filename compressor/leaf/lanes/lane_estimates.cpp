#include "compressor/leaf/lanes/lane_estimates.h"

#include "compressor/leaf/lanes/lane_fitter.h"
#include "compressor/leaf/quantiser_fit.h"

namespace weir {

WEIR_SIMD void estimate_lanes(const Floats8* values, const LaneShape& shape, const LaneRanges& ranges,
                              std::array<Doubles8, 3>& squared_errors) {
  LaneFitter fitter(values, shape, ranges);
  for (std::size_t log2 = 0; log2 < squared_errors.size(); ++log2) {
    const EstimateStart& start = kEstimateStarts[log2];
    const auto most = static_cast<float>((1U << (1U << log2)) - 1U);
    fitter.start(start.share, start.rounds, most, squared_errors[log2]);
  }
}

}  // namespace weir
