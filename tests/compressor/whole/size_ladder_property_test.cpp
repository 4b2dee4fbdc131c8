// A larger budget never does worse. Tested over ladders of sizes of random volumes, for every encoding. `auto` is never
// worse than the encodings that it chooses from. WEIR_PROPERTY_VOLUMES sets the number of volumes.
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <optional>

#include "compressor/conversion.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/random_volumes.h"

namespace weir::size_ladder_property_test {
namespace {

using test::RandomVolume;

// Returns the error at `rate`; nullopt if the smallest tree takes more bytes than that.
std::optional<double> error_at(RandomVolume& random, Encoding encoding, double rate) {
  ConversionOptions options;
  options.encoding = encoding;
  options.budget = {Budget::Kind::rate, rate, 0, 0};
  try {
    return test::convert(random.volume, options).sidecar.error.mse;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::budget) << error.what();
    return std::nullopt;
  }
}

constexpr std::array kEncodings{Encoding::automatic, Encoding::fpn, Encoding::float32,
                                Encoding::fp4,       Encoding::fp8, Encoding::fp16};

TEST(SizeLadderProperty, ALargerBudget_NeverDoesWorse) {
  const std::uint64_t volumes = test::property_volumes(12);
  for (std::uint64_t seed = 0; seed < volumes; ++seed) {
    RandomVolume random = test::random_volume(seed, 64);
    std::array<double, 6> last{};
    last.fill(std::numeric_limits<double>::infinity());
    for (const double rate :
         {64.0, 24.0, 12.0, 8.0, 6.0, 5.0, 4.0, 3.2, 2.6, 2.2, 1.9, 1.6, 1.4, 1.2, 1.05, 1.0, 0.9}) {
      SCOPED_TRACE(cat(random.name, ", --rate ", rate));
      std::array<double, 6> now{};
      for (std::size_t i = 0; i < now.size(); ++i) {
        const Encoding encoding = kEncodings[i];
        now[i] = error_at(random, encoding, rate).value_or(std::numeric_limits<double>::infinity());
        // The best levels of a leaf are found in single precision.
        EXPECT_LE(now[i], last[i] * (1 + 1e-6)) << encoding_name(encoding);
      }
      EXPECT_LE(now[0], std::min(now[1], now[2]) * (1 + 1e-12)) << "auto is worse than fpn or float";
      last = now;
    }
  }
}

}  // namespace
}  // namespace weir::size_ladder_property_test
