#include "compressor/survey/survey_tally.h"

#include <algorithm>

namespace weir {

void SurveyTally::merge(const SurveyTally& other) {
  // Either of -0.0 and 0.0 may be met first. Adding 0.0 turns both into 0.0.
  min = std::min(min, other.min) + 0.0F;
  max = std::max(max, other.max) + 0.0F;
  finite += other.finite;
  missing += other.missing;
  non_finite += other.non_finite;
  if (other.first_non_finite < first_non_finite) {
    first_non_finite = other.first_non_finite;
    first_non_finite_value = other.first_non_finite_value;
  }
  first_missing = std::min(first_missing, other.first_missing);
  histogram.merge(other.histogram);
  value_counts.resize(std::max(value_counts.size(), other.value_counts.size()));
  for (std::size_t i = 0; i < other.value_counts.size(); ++i) value_counts[i] += other.value_counts[i];
  loss.add(other.loss);
  sums.add(other.sums);
}

}  // namespace weir
