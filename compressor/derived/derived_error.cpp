#include "compressor/derived/derived_error.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <cmath>
#include <vector>

#include "compressor/compare/pair_stream.h"

namespace weir {
namespace {

/// The margin for the neighbours of a block, and for windows that begin at its last voxel.
constexpr PairMargin kWithWindows{1, SimilarityTally::kWindow - 1};
constexpr PairMargin kNeighbours{1, 1};

struct DerivedTally {
  ErrorHistogram errors;
  GradientTally gradient;
  SimilarityTally similarity;

  void add(const ValuePair& values, const Box& part) {
    for_each_index(part, [&](const Index3& i) {
      const std::size_t at = values.at(i);
      if (values.finite(at)) errors.add(std::fabs(values.error(at)));
    });
    gradient.add(values, part);
    similarity.add(values, part);
  }
  void merge(const DerivedTally& other) {
    errors.add(other.errors);
    gradient.merge(other.gradient);
    similarity.merge(other.similarity);
  }
};

}  // namespace

DerivedErrors derive_errors(VolumeSource& source, const NvdbGrid& grid, const Comparison& compared,
                            const CompareOptions& options) {
  const MinMax range = compared.range.value_or(MinMax{0, 0});
  const DerivedTally none{
      {}, GradientTally(source.info().spacing), SimilarityTally(double{range.min}, double{range.max})};
  tbb::enumerable_thread_specific<DerivedTally> tallies(none);
  stream_pairs(source, grid, kWithWindows, options,
               [&](const ValuePair& values, const Box& part) { tallies.local().add(values, part); });
  DerivedTally total = none;
  for (const DerivedTally& tally : tallies) total.merge(tally);
  DerivedErrors all;
  for (std::size_t i = 0; i < DerivedErrors::kShares.size(); ++i) {
    all.quantiles[i] = total.errors.quantile(DerivedErrors::kShares[i], compared.error.max_abs);
  }
  all.octaves = total.errors.octaves();
  all.gradient = total.gradient.result();
  all.similarity = total.similarity.result();
  return all;
}

GradientError gradient_error(VolumeSource& source, const NvdbGrid& grid, const CompareOptions& options, Team& team) {
  const GradientTally none(source.info().spacing);
  tbb::enumerable_thread_specific<GradientTally> tallies(none);
  team.run([&] {
    stream_pairs(
        source, grid, kNeighbours, options,
        [&](const ValuePair& values, const Box& part) { tallies.local().add(values, part); }, team);
  });
  std::vector<GradientTally> total{none};
  for (const GradientTally& tally : tallies) total.front().merge(tally);
  team.concatenate(total);  // one tally per rank
  for (std::size_t i = 1; i < total.size(); ++i) total.front().merge(total[i]);
  return total.front().result();
}

}  // namespace weir
