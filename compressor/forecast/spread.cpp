#include "compressor/forecast/spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace weir {

Expected spread_of(double value, std::span<const double> parts, double share) {
  // For 1 to 7 degrees of freedom.
  constexpr std::array<double, 7> kStudent{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365};
  const std::size_t n = parts.size();
  if (n < 2) return {value, value, value};
  const double count = static_cast<double>(n);
  const double mean = std::accumulate(parts.begin(), parts.end(), 0.0) / count;
  double squares = 0;
  for (const double part : parts) squares += (part - mean) * (part - mean);
  const double error = std::sqrt(squares / (count - 1) / count * std::max(0.0, 1 - share));
  const double width = kStudent[std::min(n - 2, kStudent.size() - 1)] * error;
  return {value, value - width, value + width};
}

}  // namespace weir
