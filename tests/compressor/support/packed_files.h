// Volumes for tests of packed conversions, and checks of what a packed file must hold according to its source.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "format/nanovdb/read_box.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/memory_volume.h"

namespace weir::test {

inline constexpr Box kPackedDomain{{-9, 3, 120}, {61, 70, 181}};

inline float smooth(const Index3& i) {
  const auto x = static_cast<double>(i.x);
  const auto y = static_cast<double>(i.y);
  const auto z = static_cast<double>(i.z);
  return static_cast<float>(std::sin(x * 0.11) * std::cos(y * 0.07 + z * 0.05) + 0.3 * std::sin(z * 0.21) + 2);
}

inline ConversionOptions packed(Budget::Kind kind, double value) {
  ConversionOptions options;
  options.encoding = Encoding::packed;
  options.budget.kind = kind;
  if (kind == Budget::Kind::size) {
    options.budget.bytes = static_cast<std::uint64_t>(value);
  } else if (kind == Budget::Kind::rate) {
    options.budget.rate = value;
  } else {
    options.budget.target = value;
  }
  return options;
}

inline std::vector<float> decoded(const Converted& converted, const Box& domain) {
  std::vector<float> values(static_cast<std::size_t>(domain.voxels()));
  read_box(converted.grid(), domain, values);
  return values;
}

struct PackedLoss {
  double squared = 0;
  double max_abs = 0;
  bool exact = true;
  std::uint64_t finite = 0;
};

inline PackedLoss loss_of(const MemoryVolume& volume, const Converted& converted, float background,
                          NonFinitePolicy policy) {
  const Box domain = volume.info().domain();
  const std::vector<float> values = decoded(converted, domain);
  PackedLoss loss;
  for (std::size_t i = 0; i < values.size(); ++i) {
    float source = volume.values()[i];
    if (std::isfinite(source)) {
      const double error = std::fabs(static_cast<double>(source) - static_cast<double>(values[i]));
      loss.squared += error * error;
      loss.max_abs = std::max(loss.max_abs, error);
      ++loss.finite;
    } else if (policy == NonFinitePolicy::background) {
      source = background;
    }
    loss.exact = loss.exact && bits_of(source) == bits_of(values[i]);
  }
  return loss;
}

inline void expect_certificate(const MemoryVolume& volume, const Converted& converted, const ConversionOptions& options,
                               const std::string& what) {
  const PackedLoss loss =
      loss_of(volume, converted, static_cast<float>(converted.sidecar.background.value), options.non_finite);
  const Sidecar::CertifiedError& error = converted.sidecar.error;
  const double mse = loss.finite == 0 ? 0 : loss.squared / static_cast<double>(loss.finite);
  EXPECT_NEAR(error.mse, mse, mse * 1e-9) << what;
  EXPECT_EQ(error.max_abs, loss.max_abs) << what;
  EXPECT_EQ(error.lossless, loss.exact) << what;
}

}  // namespace weir::test
