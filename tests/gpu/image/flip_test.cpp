// The expected numbers come from the authors' C++ implementation on the same pairs (NVlabs/flip at 1eb247c: FLIP.h,
// pooled as its tool does). It computes in single precision as well. Where two colours are nearly equal, the powers
// of 0.7 and 0.5 turn rounding errors of 1e-7 into 1e-4, in the authors' code (at most 2.3e-4 against itself in
// double precision) as in ours (3.6e-4). Single pixels are therefore compared no more closely.
#include "gpu/image/flip.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <string>

#include "format/base/error.h"
#include "gpu/image/colormap.h"
#include "tests/gpu/support/flip_pairs.h"

namespace weir::flip_test {
namespace {

Image image_of(const std::vector<test::Srgb>& pixels, std::int32_t width, std::int32_t height) {
  Image image(width, height);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto channel = [&](std::size_t c) { return linear_from_srgb(static_cast<float>(pixels[i][c]) / 255.0F); };
    image.pixels[i] = {channel(0), channel(1), channel(2)};
  }
  return image;
}

std::vector<float> errors_of(const test::FlipPair& pair) {
  return flip_errors(image_of(pair.reference, pair.width, pair.height), image_of(pair.test, pair.width, pair.height),
                     pair.pixels_per_degree);
}

struct Expected {
  std::string name;
  double mean;
  double weighted_median;
  double first_weighted_quartile;
  double third_weighted_quartile;
  double min;
  double max;
  std::array<double, 3> pixels;  ///< the first pixel, the one at size / 2 + width / 3, the last
};

TEST(Flip, MatchesTheReferenceImplementation) {
  const std::vector<Expected> expected{
      {"noise on a gradient",
       0.1341546,
       0.149816,
       0.1113487,
       0.1969432,
       0.01592104,
       0.4426377,
       {0.1598614, 0.085342, 0.1604721}},
      {"the same seen from further away",
       0.09124011,
       0.09927508,
       0.07533388,
       0.1296062,
       0.01276479,
       0.3985842,
       {0.1361518, 0.05601555, 0.2164495}},
      {"the same seen from near",
       0.3867679,
       0.4259714,
       0.3378059,
       0.5257231,
       0.01867004,
       0.8007946,
       {0.1831415, 0.5705621, 0.4371447}},
      {"checkerboard against its mean",
       0.01963073,
       0.01740053,
       0.01702259,
       0.01865565,
       0.004368694,
       0.5193581,
       {0.519358, 0.01696726, 0.5193581}},
      {"checkerboard of 8 pixels shifted by one",
       0.252871,
       0.4608012,
       0.3161162,
       0.5674927,
       0,
       0.7181102,
       {0, 0.4435665, 0}},
      {"thin lines, one missing", 0.05291282, 0.9234094, 0.6767321, 0.9307335, 0, 0.9727095, {0, 0, 0}},
      {"a single dot", 0.002326467, 0.05705013, 0.01369507, 0.1309753, 0, 0.2288459, {0, 0, 0}},
      {"brighter by 10",
       0.1780179,
       0.1775073,
       0.172242,
       0.1852993,
       0.1289126,
       0.1975235,
       {0.1289126, 0.1821283, 0.1588613}},
      {"green against blue", 1, 1, 1, 1, 1, 1, {1, 1, 1}},
      {"black against white",
       0.9673883,
       0.9673883,
       0.9673883,
       0.9673883,
       0.9673883,
       0.9673883,
       {0.9673883, 0.9673883, 0.9673883}},
      {"one pixel",
       0.9111757,
       0.9111757,
       0.9111757,
       0.9111757,
       0.9111757,
       0.9111757,
       {0.9111757, 0.9111757, 0.9111757}},
      {"smaller than the filters",
       0.3563938,
       0.3766308,
       0.3686187,
       0.4773096,
       0.2150749,
       0.4848543,
       {0.2158102, 0.3764271, 0.4773096}},
      {"one row", 0.757996, 0.9683167, 0.7874957, 0.9727527, 0.1266314, 0.9749095, {0.9740322, 0.9683167, 0.9727198}},
      {"one column", 0.843249, 0.9604698, 0.8393716, 0.9682596, 0.1599643, 0.9864089, {0.911292, 0.8716389, 0.6683304}},
      {"several bands of rows",
       0.7521178,
       0.7811676,
       0.6802976,
       0.8825663,
       0.3467087,
       0.9879484,
       {0.5177674, 0.728292, 0.6201335}},
  };
  const std::vector<test::FlipPair> pairs = test::flip_pairs();
  ASSERT_EQ(pairs.size(), expected.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const test::FlipPair& pair = pairs[i];
    const Expected& e = expected[i];
    SCOPED_TRACE(pair.name);
    ASSERT_EQ(pair.name, e.name);
    const std::vector<float> errors = errors_of(pair);
    const FlipSummary found = summarise_flip(errors);
    EXPECT_NEAR(found.mean, e.mean, 1e-5);
    EXPECT_NEAR(found.weighted_median, e.weighted_median, 1e-5);
    EXPECT_NEAR(found.first_weighted_quartile, e.first_weighted_quartile, 1e-5);
    EXPECT_NEAR(found.third_weighted_quartile, e.third_weighted_quartile, 1e-5);
    EXPECT_NEAR(found.min, e.min, 1e-4);
    EXPECT_NEAR(found.max, e.max, 1e-4);
    ASSERT_EQ(errors.size(), pair.reference.size());
    EXPECT_NEAR(errors.front(), e.pixels[0], 1e-4);
    EXPECT_NEAR(errors[errors.size() / 2 + static_cast<std::size_t>(pair.width / 3)], e.pixels[1], 1e-4);
    EXPECT_NEAR(errors.back(), e.pixels[2], 1e-4);
  }
}

TEST(Flip, IdenticalPicturesHaveZeroError) {
  for (const test::FlipPair& pair : test::flip_pairs()) {
    const Image image = image_of(pair.test, pair.width, pair.height);
    EXPECT_EQ(flip_errors(image, image, pair.pixels_per_degree), std::vector<float>(image.pixels.size(), 0.0F))
        << pair.name;
  }
}

TEST(Flip, TheOrderOfThePicturesDoesNotMatter) {
  for (const test::FlipPair& pair : test::flip_pairs()) {
    const Image a = image_of(pair.reference, pair.width, pair.height);
    const Image b = image_of(pair.test, pair.width, pair.height);
    EXPECT_EQ(flip_errors(a, b, pair.pixels_per_degree), flip_errors(b, a, pair.pixels_per_degree)) << pair.name;
  }
}

TEST(Flip, TheSameForAnyNumberOfThreads) {
  const test::FlipPair pair = test::flip_pairs().back();
  const std::vector<float> all = errors_of(pair);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(errors_of(pair), all);
}

// Pictures turned on their side give errors turned on their side: no axis is used for another.
TEST(Flip, TransposedPicturesGiveTransposedErrors) {
  const test::FlipPair pair = test::flip_pairs().front();
  test::FlipPair turned{"turned", pair.height, pair.width, pair.pixels_per_degree, pair.reference, pair.test};
  const auto at = [](std::int32_t x, std::int32_t y, std::int32_t width) {
    return static_cast<std::size_t>(y * width + x);
  };
  for (std::int32_t y = 0; y < pair.height; ++y) {
    for (std::int32_t x = 0; x < pair.width; ++x) {
      turned.reference[at(y, x, pair.height)] = pair.reference[at(x, y, pair.width)];
      turned.test[at(y, x, pair.height)] = pair.test[at(x, y, pair.width)];
    }
  }
  const std::vector<float> errors = errors_of(pair);
  const std::vector<float> errors_turned = errors_of(turned);
  for (std::int32_t y = 0; y < pair.height; ++y) {
    for (std::int32_t x = 0; x < pair.width; ++x) {
      ASSERT_NEAR(errors_turned[at(y, x, pair.height)], errors[at(x, y, pair.width)], 1e-5F) << x << ' ' << y;
    }
  }
}

TEST(Flip, ValuesBeyondTheDisplayRangeAreClamped) {
  Image dark(20, 20);
  Image bright = dark;
  for (std::size_t i = 0; i < bright.pixels.size(); ++i) {
    dark.pixels[i] = {0, 1, 0};
    bright.pixels[i] = {std::numeric_limits<float>::quiet_NaN(), kInfinity, -3};
  }
  EXPECT_EQ(summarise_flip(flip_errors(dark, bright, 67)), FlipSummary{});
}

TEST(Flip, EveryAllowedDisplayGivesNumbersFromZeroToOne) {
  const test::FlipPair pair = test::flip_pairs()[5];
  for (const double ppd : {kFlipMinPixelsPerDegree, 1.7, 12.0, 300.0, kFlipMaxPixelsPerDegree}) {
    const std::vector<float> errors = flip_errors(image_of(pair.reference, pair.width, pair.height),
                                                  image_of(pair.test, pair.width, pair.height), ppd);
    for (const float e : errors) ASSERT_TRUE(e >= 0 && e <= 1) << ppd << ' ' << e;
    EXPECT_GT(summarise_flip(errors).max, 0) << ppd;
  }
}

TEST(Flip, Refusals) {
  const auto message = [](const Image& a, const Image& b, double ppd) -> std::string {
    try {
      flip_errors(a, b, ppd);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message(Image(4, 3), Image(3, 4), 67), "pictures of 4 x 3 and 3 x 4 pixels; give two of one size");
  EXPECT_EQ(message(Image(), Image(), 67), "pictures without a pixel; give some");
  EXPECT_EQ(message(Image(1, 1), Image(1, 1), 0.5), "0.5 pixels per degree; give 1 to 1000");
  EXPECT_EQ(message(Image(1, 1), Image(1, 1), std::nan("")), "nan pixels per degree; give 1 to 1000");
  EXPECT_EQ(message(Image(1, 1), Image(1, 1), 1e30), "1e+30 pixels per degree; give 1 to 1000");
}

TEST(FlipSummary, Percentiles) {
  const std::vector<float> errors{0.5F, 0, 0.25F, 0.125F, 0.125F};
  EXPECT_EQ(summarise_flip(errors), (FlipSummary{.mean = 0.2,
                                                 .median = 0.125,
                                                 .weighted_median = 0.5,
                                                 .first_weighted_quartile = 0.25,
                                                 .third_weighted_quartile = 0.5,
                                                 .min = 0,
                                                 .max = 0.5}));
  EXPECT_EQ(summarise_flip(std::vector<float>{0.5F, 0.25F}).median, 0.375);
  EXPECT_EQ(summarise_flip(std::vector<float>{0.5F}).first_weighted_quartile, 0.5);
}

TEST(FlipPicture, BlackToYellow) {
  const Image picture = flip_picture(std::vector<float>{0, 0.5F, 1, 1.0000001F}, 2, 2);
  const std::vector<Float3> magma = colormap("magma", 256);
  EXPECT_EQ(picture.pixels, (std::vector<Float3>{magma[0], magma[128], magma[255], magma[255]}));
  EXPECT_EQ(picture.at(1, 0), magma[128]);
}

}  // namespace
}  // namespace weir::flip_test
