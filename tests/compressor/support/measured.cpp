#include "tests/compressor/support/measured.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/stock/stock_tree.h"

namespace weir::test {
namespace {

float rounded_up(double value) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity())
                                              : rounded;
}

}  // namespace

Measured measure(const MemoryVolume& volume, const Converted& converted, NonFinitePolicy policy) {
  const StockReader reader(converted.file);
  EXPECT_TRUE(reader.valid());
  EXPECT_EQ(reader.index_bbox(), volume.info().domain());
  const float background = converted.grid().background();
  Measured measured;
  long double squares = 0;
  const Box domain = volume.info().domain();
  for (std::int64_t n = 0; n < domain.voxels(); ++n) {
    const Index3 i = domain.lo + index_at(n, domain.extent());
    const float v = volume.at(i);
    const float read = reader.value(i);
    const bool replaced = !std::isfinite(v) && policy == NonFinitePolicy::background;
    measured.lossless = measured.lossless && bits_of(read) == bits_of(replaced ? background : v);
    if (!std::isfinite(v)) continue;
    measured.min = measured.finite == 0 ? v : std::min(measured.min, v);
    measured.max = measured.finite == 0 ? v : std::max(measured.max, v);
    ++measured.finite;
    const long double d = std::abs(static_cast<long double>(v) - static_cast<long double>(read));
    squares += d * d;
    measured.max_abs = std::max(measured.max_abs, static_cast<double>(d));
  }
  if (measured.finite > 0) measured.mse = static_cast<double>(squares / static_cast<long double>(measured.finite));
  return measured;
}

void expect_certificate(const Converted& converted, const Measured& measured) {
  const Sidecar& sidecar = converted.sidecar;
  const auto& error = sidecar.error;
  EXPECT_NEAR(error.mse, measured.mse, measured.mse * 1e-12);
  EXPECT_NEAR(error.rmse, std::sqrt(measured.mse), std::sqrt(measured.mse) * 1e-12);
  if (converted.grid().type() == GridType::float32) {
    EXPECT_EQ(error.max_abs, measured.max_abs);
  } else {
    EXPECT_GE(error.max_abs, measured.max_abs);
    EXPECT_LE(error.max_abs, static_cast<double>(rounded_up(measured.max_abs)));
  }
  EXPECT_EQ(error.lossless, measured.lossless);
  const double range = static_cast<double>(measured.max) - static_cast<double>(measured.min);
  if (measured.finite > 0) {
    EXPECT_EQ(sidecar.value_range[0], static_cast<double>(measured.min));
    EXPECT_EQ(sidecar.value_range[1], static_cast<double>(measured.max));
  } else {
    EXPECT_TRUE(std::isnan(sidecar.value_range[0]) && std::isnan(sidecar.value_range[1]));
  }
  EXPECT_EQ(error.psnr_db.has_value(), measured.mse > 0 && range > 0);
  if (error.psnr_db) {
    EXPECT_NEAR(*error.psnr_db, 20 * std::log10(range) - 10 * std::log10(measured.mse), 1e-9);
    const double unit = std::sqrt(measured.mse) / range;
    EXPECT_NEAR(error.nmse, unit * unit, unit * unit * 1e-12);
  }
}

}  // namespace weir::test
