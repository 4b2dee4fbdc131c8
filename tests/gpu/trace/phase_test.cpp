#include "gpu/trace/phase.h"

#include <gtest/gtest.h>

#include "tests/gpu/support/test_medium.h"

namespace weir::phase_test {
namespace {

TEST(Phase, IntegratesToOneAndHasMeanCosineG) {
  for (const float g : {-0.9F, -0.3F, 0.0F, 0.5F, 0.95F}) {
    double sum = 0;
    double cosine = 0;
    constexpr int kSteps = 200000;
    for (int i = 0; i < kSteps; ++i) {
      const double c = -1 + 2 * (i + 0.5) / kSteps;
      const double p = static_cast<double>(phase(static_cast<float>(c), g)) * 2 * 3.14159265358979 * 2 / kSteps;
      sum += p;
      cosine += c * p;
    }
    EXPECT_NEAR(sum, 1.0, 1e-4) << g;
    EXPECT_NEAR(cosine, static_cast<double>(g), 1e-4) << g;
  }
}

TEST(SamplePhase, MeanCosineIsG) {
  const Float3 forward = normalised(Float3{1, -2, 0.5F}, {});
  for (const float g : {-0.9F, -0.3F, 0.0F, 5e-4F, 0.5F, 0.95F}) {
    const auto cosine = test::estimate(100000, [&](Random& random) {
      const float u = random.uniform();
      const Float3 d = sample_phase(forward, g, u, random.uniform());
      EXPECT_NEAR(length(d), 1.0F, 1e-5F);
      return dot(d, forward);
    });
    EXPECT_NEAR(cosine.mean, static_cast<double>(g), 4.5 * cosine.sigma) << g;
  }
}

TEST(SamplePhase, EndsOfTheUnitInterval) {
  constexpr float kAlmostOne = 1.0F - 0x1p-24F;
  for (const Float3 forward : {Float3{0, 0, 1}, Float3{0, 0, -1}, Float3{1, 0, 0}, Float3{0, -1, 0}}) {
    for (const float g : {-0.99F, 0.0F, 0.99F}) {
      for (const float u1 : {0.0F, kAlmostOne, 1.0F}) {
        for (const float u2 : {0.0F, kAlmostOne, 1.0F}) {
          EXPECT_NEAR(length(sample_phase(forward, g, u1, u2)), 1.0F, 1e-5F);
        }
      }
    }
  }
}

}  // namespace
}  // namespace weir::phase_test
