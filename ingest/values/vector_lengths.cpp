#include "ingest/values/vector_lengths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "ingest/values/convert_values.h"
#include "ingest/values/decode_values.h"

namespace weir {

double squared_part(double number) {
  constexpr double kMost = 1e150;
  const double size = std::isfinite(number) ? std::min(std::fabs(number), kMost) : number;
  return size * size;
}

ConversionLoss take_lengths(std::span<double> sums, std::span<const bool> missing, std::span<float> values) {
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = missing[i] ? 0.0 : std::sqrt(sums[i]);
  const ConversionLoss loss =
      convert_values(std::as_bytes(std::span<const double>(sums)), ScalarType::float64, kNativeIsBig, values);
  const float mark = missing_value();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) values[i] = std::numeric_limits<float>::quiet_NaN();
    if (missing[i]) std::memcpy(&values[i], &mark, sizeof mark);
  }
  return loss;
}

}  // namespace weir
