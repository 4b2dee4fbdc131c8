#include "compressor/leaf/leaf_quantiser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "format/leaf/leaf_decode.h"

namespace weir::leaf_quantiser_test {
namespace {

ValueRange range_of(const std::vector<float>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v);
  return {*low, *high, static_cast<float>(sum / static_cast<double>(values.size()))};
}

double decoded_error(const std::vector<float>& values, const Quantiser& q, unsigned bits) {
  std::vector<std::uint16_t> codes(values.size());
  quantise(values, q, codes);
  double error = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_LT(codes[i], 1U << bits);
    const double d = static_cast<double>(values[i]) - static_cast<double>(dequantize(codes[i], q.quantum, q.minimum));
    error += d * d;
  }
  return error;
}

std::vector<float> noise(std::size_t count, float scale, float offset, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> values(count);
  for (float& v : values) {
    float sum = 0;  // four terms are close enough to a normal distribution, and the same on every machine
    for (int k = 0; k < 4; ++k) sum += static_cast<float>(random() % 65536) / 65536.0F - 0.5F;
    v = offset + scale * sum;
  }
  return values;
}

TEST(LeafQuantiser, RefittingBeatsLevelsOverTheRange) {
  const auto values = noise(512, 3, 10, 1);
  for (const auto& [bits, least_db] :
       {std::pair{1U, 4.0}, std::pair{2U, 1.5}, std::pair{4U, 0.1}, std::pair{8U, 0.0}}) {
    const double fitted = decoded_error(values, fit_quantiser(values, range_of(values), bits), bits);
    const double plain = decoded_error(values, range_quantiser(range_of(values), bits), bits);
    EXPECT_GE(10 * std::log10(plain / fitted), least_db) << bits;
  }
}

TEST(LeafQuantiser, OneBitIsTheBestSplitInTwo) {
  // Two clusters. The least squared error is the error about the means of the best split, which is found by trying all.
  auto values = noise(300, 0.3F, 1, 2);
  const auto upper = noise(100, 0.5F, 4, 3);
  values.insert(values.end(), upper.begin(), upper.end());
  auto sorted = values;
  std::sort(sorted.begin(), sorted.end());
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t split = 1; split < sorted.size(); ++split) {
    double error = 0;
    for (const auto& [from, to] : {std::pair{std::size_t{0}, split}, std::pair{split, sorted.size()}}) {
      double mean = 0;
      for (std::size_t i = from; i < to; ++i) mean += static_cast<double>(sorted[i]) / static_cast<double>(to - from);
      for (std::size_t i = from; i < to; ++i) error += std::pow(static_cast<double>(sorted[i]) - mean, 2);
    }
    best = std::min(best, error);
  }
  EXPECT_NEAR(decoded_error(values, fit_quantiser(values, range_of(values), 1), 1), best, 1e-3 * best);
}

TEST(LeafQuantiser, ScalingTheValuesScalesTheFit) {
  const auto values = noise(512, 3, 10, 4);
  for (const float scale : {0x1p-60F, 0x1p-100F, 0x1p+100F}) {
    std::vector<float> scaled = values;
    for (float& v : scaled) v *= scale;
    for (const unsigned bits : {1U, 2U, 4U, 8U}) {
      const Quantiser fit = fit_quantiser(values, range_of(values), bits);
      const Quantiser of_scaled = fit_quantiser(scaled, range_of(scaled), bits);
      EXPECT_EQ(of_scaled.quantum, fit.quantum * scale) << scale << ' ' << bits;
      EXPECT_EQ(of_scaled.minimum, fit.minimum * scale) << scale << ' ' << bits;
    }
  }
}

TEST(LeafQuantiser, SmallSignalOnALargeOffset) {
  std::vector<float> values = noise(512, 1e4F, 1e8F, 5);
  for (const unsigned bits : {1U, 2U, 4U, 8U}) {
    const auto range = range_of(values);
    const Quantiser fit = fit_quantiser(values, range, bits);
    const double error = decoded_error(values, fit, bits);
    EXPECT_LE(error, decoded_error(values, range_quantiser(range, bits), bits) * 1.0001);
  }
}

// Returns the values of many kinds of leaves, which are the same on every machine.
std::vector<std::vector<float>> kinds_of_leaves() {
  std::vector<std::vector<float>> kinds;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    kinds.push_back(noise(512, 3, 10, seed));
    kinds.push_back(noise(512, 1e4F, 1e8F, seed));
    kinds.push_back(noise(512, 1e-3F, -7, seed));
    kinds.push_back(noise(512, 1.5e38F, 0, seed));
    kinds.push_back(noise(37, 1e-30F, 1e-30F, seed));
    kinds.push_back(noise(512, 0x1p-117F, 0, seed));
    kinds.push_back(noise(512, 0x1p-122F, -0x1p-100F, seed));
    std::vector<float> density = noise(512, 2, -0.4F, seed);  // empty space with a density in it
    for (float& v : density) v = std::max(v, 0.0F);
    kinds.push_back(density);
    for (float& v : density) v = -v;
    kinds.push_back(density);
    std::vector<float> steep = noise(512, 9, 0, seed);
    for (float& v : steep) v = std::exp(v);
    kinds.push_back(steep);
    std::vector<float> near_lattice = noise(512, 0.02F, 0, seed);
    for (std::size_t i = 0; i < near_lattice.size(); ++i) {
      near_lattice[i] += static_cast<float>((i * 7 + seed) % (seed % 13 + 2));
    }
    kinds.push_back(near_lattice);
  }
  return kinds;
}

TEST(LeafQuantiser, EveryValue_DecodesToOneInsideTheRange) {
  for (const std::vector<float>& values : kinds_of_leaves()) {
    const ValueRange range = range_of(values);
    for (const unsigned bits : {1U, 2U, 4U, 8U, 16U}) {
      for (const Quantiser& q : {fit_quantiser(values, range, bits), range_quantiser(range, bits)}) {
        std::vector<std::uint16_t> codes(values.size());
        quantise(values, q, codes);
        for (std::size_t i = 0; i < values.size(); ++i) {
          const float decoded = dequantize(codes[i], q.quantum, q.minimum);
          ASSERT_GE(decoded, range.min) << bits << ' ' << values[i];
          ASSERT_LE(decoded, range.max) << bits << ' ' << values[i];
        }
      }
    }
  }
}

TEST(LeafQuantiser, WhereTheLeastValueIsZero_ZerosDecodeToZero) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::vector<float> values = noise(512, 2, seed % 2 == 0 ? 0.7F : -0.7F, seed);
    const float scale = seed > 40 ? std::ldexp(1.0F, 60 - 4 * static_cast<int>(seed)) : 1;  // 2^-104 to 2^-140
    for (float& v : values) v = std::max(v, 0.0F) * scale;
    values[seed] = 0;
    if (seed % 3 == 0) values[seed + 1] = -0.0F;
    for (const unsigned bits : {1U, 2U, 4U, 8U, 16U}) {
      const Quantiser fit = fit_quantiser(values, range_of(values), bits);
      std::vector<std::uint16_t> codes(values.size());
      quantise(values, fit, codes);
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] != 0) continue;
        ASSERT_EQ(dequantize(codes[i], fit.quantum, fit.minimum), 0.0F) << bits;
      }
    }
  }
}

TEST(LeafQuantiser, ARangeTooSmallForFloat_IsOneLevel) {
  for (const std::vector<float>& values : {std::vector<float>{0, 1e-44F, 3e-44F}, {1e-44F, 2e-44F, 6e-44F}}) {
    const ValueRange range = range_of(values);
    for (const unsigned bits : {2U, 8U, 16U}) {
      const Quantiser fit = fit_quantiser(values, range, bits);
      EXPECT_EQ(fit.quantum, 0.0F);
      EXPECT_EQ(fit.minimum, range.min == 0 ? 0.0F : range.mean);  // a least value of zero stays zero
      std::vector<std::uint16_t> codes(values.size());
      quantise(values, fit, codes);
      EXPECT_EQ(codes, std::vector<std::uint16_t>(values.size(), 0));
    }
  }
}

// Noise over nearly the whole range of float. Levels cover the middle of that range. Errors are relative to the error
// of the mean alone.
TEST(LeafQuantiser, ARangeBeyondFloat_HasLevelsOverAsMuchAsFloatHolds) {
  std::vector<float> values = noise(512, 1, 0, 7);
  const float most = std::fabs(
      *std::max_element(values.begin(), values.end(), [](float a, float b) { return std::fabs(a) < std::fabs(b); }));
  for (float& v : values) v *= 3.2e38F / most;
  const ValueRange range = range_of(values);
  const double about_mean = decoded_error(values, {range.mean, 0, 0}, 1);
  const std::array<double, 3> estimated = estimated_errors(values, range, 32, about_mean);
  double last = 0.5 * about_mean;
  for (const unsigned bits : {1U, 2U, 4U, 8U, 16U}) {
    const Quantiser fit = fit_quantiser(values, range, bits);
    EXPECT_GT(fit.quantum, 0.0F);
    EXPECT_TRUE(std::isfinite(fit.quantum * static_cast<float>(fit.top))) << bits;
    const double error = decoded_error(values, fit, bits);
    EXPECT_LE(error, last) << bits;
    if (bits <= 4) {
      EXPECT_NEAR(estimated[bits / 2] * about_mean / error, 1, 0.25) << bits;
    }
    last = error;
  }
  EXPECT_LT(last, 0.1 * about_mean);
}

TEST(LeafQuantiser, RangeLevelsAreWithinHalfAQuantum) {
  const auto values = noise(512, 1, 0, 6);
  for (const unsigned bits : {1U, 2U, 4U, 8U, 16U}) {
    const Quantiser q = range_quantiser(range_of(values), bits);
    std::vector<std::uint16_t> codes(values.size());
    quantise(values, q, codes);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double d = static_cast<double>(values[i]) - static_cast<double>(dequantize(codes[i], q.quantum, q.minimum));
      EXPECT_LE(std::fabs(d), 0.5 * static_cast<double>(q.quantum) * (1 + 1e-2) + 1e-7);
    }
  }
}

// Most values lie near a few levels, and a few values lie on no lattice.
std::vector<float> near_a_lattice(std::mt19937& random) {
  const auto uniform = [&] { return static_cast<float>(random() % 65536) / 65536.0F; };
  const auto levels = 2 + random() % (1U << (1 + random() % 8));
  const float scatter = random() % 2 == 0 ? 0.0F : std::pow(10.0F, -6 * uniform());
  const float scale = std::pow(10.0F, 4 * uniform() - 2);
  std::vector<float> values(512);
  for (float& v : values) v = scale * (static_cast<float>(random() % levels) + scatter * (uniform() - 0.5F));
  const float beside = scale * std::pow(10.0F, -6 * uniform());
  const auto others = 1 + random() % 40;
  for (auto i = others; i > 0; --i) values[random() % values.size()] += beside;
  return values;
}

TEST(LeafQuantiser, MoreBitsNeverDoWorse_NearALattice) {
  std::mt19937 random(11);
  for (unsigned leaf = 0; leaf < 2000; ++leaf) {
    const std::vector<float> values = near_a_lattice(random);
    const ValueRange range = range_of(values);
    double last = std::numeric_limits<double>::infinity();
    for (const unsigned bits : {1U, 2U, 4U, 8U, 16U}) {
      const double error = decoded_error(values, fit_quantiser(values, range, bits), bits);
      EXPECT_LE(error, last * 1.0001) << "leaf " << leaf << " at " << bits << " bits";
      last = error;
    }
  }
}

// The levels of few bits would lie beyond float if there were as many as levels of many bits.
TEST(LeafQuantiser, MoreBitsNeverDoWorse_NearALatticeOverNearlyAllOfFloat) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::vector<float> values = noise(512, 1e33F, 0, seed);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += 1.7e36F * static_cast<float>((i * 7 + seed) % 16);
    const ValueRange range = range_of(values);
    double last = std::numeric_limits<double>::infinity();
    for (const unsigned bits : {1U, 2U, 4U, 8U, 16U}) {
      const double error = decoded_error(values, fit_quantiser(values, range, bits), bits);
      EXPECT_LE(error, last * 1.0001) << "leaf " << seed << " at " << bits << " bits";
      last = error;
    }
  }
}

// Like a volume of labels: four values, and a few voxels that are mixtures of two labels.
TEST(LeafQuantiser, MoreBitsNeverDoWorse_NearFourLevels) {
  std::vector<float> values{0.236F, 0.819F, 1.075F, 1.306F, 2.088F, 2.22F, 2.383F, 2.497F, 2.83F, 3.334F, 3.547F};
  for (int i = 0; i < 501; ++i) values.push_back(static_cast<float>(i % 4));
  const ValueRange range = range_of(values);
  const double two = decoded_error(values, fit_quantiser(values, range, 2), 2);
  EXPECT_LE(decoded_error(values, fit_quantiser(values, range, 4), 4), two * 1.0001);
}

TEST(LeafQuantiser, EstimatesAreNearTheFit) {
  double ratio = 0;
  constexpr unsigned kLeaves = 50;
  for (const unsigned bits : {1U, 2U, 4U}) {
    ratio = 0;
    for (unsigned seed = 0; seed < kLeaves; ++seed) {
      const auto values = noise(512, 3, 10, seed);
      const ValueRange range = range_of(values);
      double squares = 0;
      for (const float v : values) squares += std::pow(static_cast<double>(v) - static_cast<double>(range.mean), 2);
      const std::array<double, 3> estimated = estimated_errors(values, range, 32, squares);
      ratio += estimated[bits / 2] * squares / decoded_error(values, fit_quantiser(values, range, bits), bits);
    }
    EXPECT_NEAR(ratio / kLeaves, 1, 0.15) << bits;
  }
}

TEST(LeafQuantiser, EstimatesStopWhereTheValuesAreExact) {
  const auto values = noise(512, 3, 10, 1);
  double squares = 0;
  const ValueRange range = range_of(values);
  for (const float v : values) squares += std::pow(static_cast<double>(v) - static_cast<double>(range.mean), 2);
  const std::array<double, 3> all = estimated_errors(values, range, 32, squares);
  EXPECT_LT(all[2], all[1]);
  EXPECT_LT(all[1], all[0]);
  EXPECT_LT(all[0], 1);
  EXPECT_EQ(estimated_errors(values, range, 4, squares), (std::array<double, 3>{all[0], all[1], 1}));
  EXPECT_EQ(estimated_errors(values, range, 1, squares), (std::array<double, 3>{1, 1, 1}));
}

}  // namespace
}  // namespace weir::leaf_quantiser_test
