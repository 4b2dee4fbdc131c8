#include "compressor/surveyed_request.h"

#include <algorithm>
#include <cmath>

#include "compressor/packed/exact_block.h"
#include "compressor/packed/ladder_builder.h"
#include "format/packed/block_coder.h"
#include "format/packed/block_encode.h"

namespace weir {

FileRequest request_for(const ConversionOptions& options, const Survey& survey, const SourceInfo& info,
                        float background) {
  FileRequest request;
  request.encoding = options.encoding;
  request.rule.metric = options.metric;
  request.rule.brick_leaves = options.brick / kLeafDim;
  request.rule.fill = {options.fill, background, options.non_finite, info.mapping.gaps};
  request.budget = options.budget;
  request.domain = info.domain();
  request.keeps_non_finite = options.non_finite == NonFinitePolicy::keep && survey.non_finite + survey.missing > 0;
  request.path = options.output;
  return request;
}

PackedRequest packed_request(const ConversionOptions& options, const Survey& survey, const SourceInfo& info,
                             float background) {
  PackedRequest packed;
  packed.preview = options.preview;
  packed.lattice = lattice_of(info);
  BlockConstants& c = packed.constants;
  const bool replaced = options.non_finite != NonFinitePolicy::keep && survey.non_finite + survey.missing > 0;
  c.minimum = replaced ? std::min(survey.min, background) : survey.min;
  c.maximum = replaced ? std::max(survey.max, background) : survey.max;
  c.coarsest = coarsest_step(survey.min, survey.max);
  const Lattice lattice = packed.lattice.value_or(kWholeNumbers);
  c.lattice_minimum = lattice.minimum;
  c.lattice_quantum = lattice.quantum;
  c.lattice_bits = lattice.bits;
  c.below_one = kBelowOne;
  c.below_more = kBelowMore;
  c.tables = built_in_tables();
  return packed;
}

bool raises_default(const ConversionOptions& options, const Box& domain) {
  constexpr std::int64_t kSmall = std::int64_t{128} * 128 * 128;
  return options.budget.kind == Budget::Kind::automatic && domain.voxels() < kSmall && !options.scene &&
         options.metric == Metric::sse && options.encoding != Encoding::fp4;
}

double allowed_error(const Budget& budget, const Survey& survey, std::uint64_t finite) {
  const double range = static_cast<double>(survey.max) - static_cast<double>(survey.min);
  return range * range * static_cast<double>(finite) / std::pow(10, budget.target / 10);
}

}  // namespace weir
