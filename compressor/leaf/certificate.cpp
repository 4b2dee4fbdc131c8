#include "compressor/leaf/certificate.h"

#include <cmath>
#include <limits>

namespace weir {

Certificate make_certificate(double squared_error, double max_abs, bool lossless, std::uint64_t finite, float min,
                             float max) {
  Certificate c;
  c.lossless = lossless;
  c.max_abs = max_abs;
  c.mse = finite == 0 ? 0 : squared_error / static_cast<double>(finite);
  c.rmse = std::sqrt(c.mse);
  const double range = static_cast<double>(max) - static_cast<double>(min);
  if (range == 0 && c.mse > 0) c.nmse = std::numeric_limits<double>::infinity();
  if (range > 0) {
    // Divides before squaring, because range^2 of a field of 1e-40 would underflow.
    c.nmse = c.rmse / range * (c.rmse / range);
    if (c.mse > 0) c.psnr_db = 20.0 * std::log10(range / c.rmse);
  }
  return c;
}

}  // namespace weir
