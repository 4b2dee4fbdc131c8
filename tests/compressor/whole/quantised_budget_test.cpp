// What quantised encodings promise about sizes: the first width that holds a leaf's numbers, the fallback to float with
// its reason, and refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "compressor/select/leaf_choice.h"
#include "format/base/error.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/hard_cases.h"
#include "tests/compressor/support/measured.h"

namespace weir::quantised_budget_test {
namespace {

using test::Converted;
using test::MemoryVolume;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

// 2 x 2 x 2 leaves.
constexpr Box kDomain{{0, 0, 0}, {16, 16, 16}};

float pseudo_random(const Index3& i, std::int64_t levels) {
  const std::int64_t n = linear_index(i, {16, 16, 16});
  return static_cast<float>((n * 7919 + n * n % 104729) % levels);
}

Converted lossless(MemoryVolume& volume, Encoding encoding) {
  ConversionOptions options;
  options.encoding = encoding;
  options.budget.kind = Budget::Kind::lossless;
  return test::convert(volume, options);
}

void expect_refused(MemoryVolume& volume, const ConversionOptions& options, ErrorKind kind,
                    const std::string& message) {
  try {
    test::convert(volume, options);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    EXPECT_EQ(error.what(), message);
  }
}

TEST(QuantisedBudget, AtMost_LosesNoMoreThanAFileOfThatSize) {
  MemoryVolume volume({{0, 0, 0}, {40, 40, 40}}, [](const Index3& i) {
    return std::sin(static_cast<float>(i.x) * 0.21F) +
           std::sin(static_cast<float>(i.y) * 0.17F) * static_cast<float>(i.z);
  });
  ConversionOptions options;
  options.encoding = Encoding::automatic;
  const std::uint64_t minimum = test::minimum_size(volume, options);
  for (const std::uint64_t more : {50'000, 150'000, 280'000, 400'000, 2'000'000}) {
    options.budget = {Budget::Kind::size, 8, minimum + more, 0};
    const Converted padded = test::convert(volume, options);
    options.budget.at_most = true;
    const Converted shorter = test::convert(volume, options);
    EXPECT_EQ(shorter.sidecar.error.mse, padded.sidecar.error.mse) << more;
    EXPECT_EQ(shorter.sidecar.grid.type, padded.sidecar.grid.type) << more;
    EXPECT_LE(shorter.file.size(), padded.file.size()) << more;
  }
}

TEST(QuantisedBudget, WholeNumbersTakeTheFirstWidthThatHoldsThem) {
  for (const auto& [levels, width] : {std::pair{2, LeafWidth::bits1},
                                      {4, LeafWidth::bits2},
                                      {16, LeafWidth::bits4},
                                      {17, LeafWidth::bits8},
                                      {256, LeafWidth::bits8},
                                      {257, LeafWidth::bits16},
                                      {65536, LeafWidth::bits16}}) {
    for (const float step : {1.0F, 0.125F, 3.0F, 0x1p-80F}) {
      MemoryVolume volume(kDomain, [&, levels = levels](const Index3& i) {
        // Every leaf has both ends, so that it needs the whole range.
        const Index3 in_leaf{i.x % 8, i.y % 8, i.z % 8};
        const float code = in_leaf == Index3{1, 2, 3}   ? 0.0F
                           : in_leaf == Index3{4, 5, 6} ? static_cast<float>(levels - 1)
                           : in_leaf == Index3{4, 5, 7} ? 1.0F  // no coarser lattice
                                                        : pseudo_random(i, levels);
        return (code - 100) * step;
      });
      const Converted plain = lossless(volume, Encoding::float32);
      const Converted best = lossless(volume, Encoding::automatic);
      SCOPED_TRACE(std::to_string(levels) + " levels of " + std::to_string(step));
      EXPECT_EQ(best.grid().type(), GridType::fpn);
      EXPECT_EQ(best.sidecar.selection.bits[bits_log2_of(width)], 8U);
      EXPECT_EQ(plain.file.size() - best.file.size(), 8 * (2144 - leaf_bytes(width)));
      EXPECT_TRUE(test::measure(volume, best, NonFinitePolicy::error).lossless);
    }
  }
}

TEST(QuantisedBudget, MixedVolumesFallBackToFloatAndSayWhy) {
  MemoryVolume volume(kDomain, [](const Index3& i) {
    const float v = pseudo_random(i, 100);
    return i.x < 8 ? v : std::sqrt(v);
  });
  const Converted best = lossless(volume, Encoding::automatic);
  EXPECT_EQ(best.grid().type(), GridType::float32);
  EXPECT_EQ(best.notices, (std::vector<std::string>{"out.nvdb: 4 blocks need full float32 to be lossless"}));
  ConversionOptions options;
  options.budget.kind = Budget::Kind::lossless;
  for (const Encoding encoding : {Encoding::fpn, Encoding::fp16}) {
    options.encoding = encoding;
    expect_refused(volume, options, ErrorKind::budget,
                   "out.nvdb: --encoding " + encoding_name(encoding) +
                       " cannot be lossless: 4 blocks need full float32; use --encoding auto or float");
  }
}

TEST(QuantisedBudget, BlocksWithVoxelsWithoutAValueAreLosslessWhereTheBackgroundIsOnTheirLattice) {
  MemoryVolume volume(kDomain, [](const Index3& i) { return i == Index3{9, 9, 9} ? kNaN : pseudo_random(i, 200); });
  ConversionOptions options;
  options.budget.kind = Budget::Kind::lossless;
  options.non_finite = NonFinitePolicy::background;
  for (const auto& [background, type] : {std::pair{0.0F, GridType::fpn}, std::pair{0.1F, GridType::float32}}) {
    options.background = background;
    options.encoding = Encoding::automatic;
    const Converted best = test::convert(volume, options);
    SCOPED_TRACE(background);
    EXPECT_EQ(best.grid().type(), type);
    EXPECT_TRUE(best.sidecar.error.lossless);
    EXPECT_TRUE(test::measure(volume, best, NonFinitePolicy::background).lossless);
    options.encoding = Encoding::float32;
    const Converted floats = test::convert(volume, options);
    if (type == GridType::fpn) {
      EXPECT_EQ(best.sidecar.selection.bits[bits_log2_of(LeafWidth::bits8)], 8U);
      EXPECT_EQ(floats.file.size() - best.file.size(), 8 * (2144 - leaf_bytes(LeafWidth::bits8)));
      EXPECT_TRUE(best.notices.empty());
    } else {
      EXPECT_EQ(best.file, floats.file);
      EXPECT_EQ(best.notices, (std::vector<std::string>{"out.nvdb: 1 block needs full float32 to be lossless"}));
    }
  }
}

TEST(QuantisedBudget, OneZeroOfAnotherSignTakesFloat) {
  MemoryVolume volume(kDomain, [](const Index3& i) { return i == Index3{9, 9, 9} ? -0.0F : 0.0F; });
  const Converted best = lossless(volume, Encoding::automatic);
  EXPECT_EQ(best.grid().type(), GridType::float32);
  EXPECT_EQ(best.notices, (std::vector<std::string>{"out.nvdb: 1 block needs full float32 to be lossless"}));
  EXPECT_TRUE(test::measure(volume, best, NonFinitePolicy::error).lossless);
}

TEST(QuantisedBudget, AutoAtTheSizeOfLosslessFloatsIsLossless) {
  for (const test::HardCase& hard : test::hard_cases()) {
    MemoryVolume volume = hard.make();
    if (test::policies_of(volume).front() != NonFinitePolicy::error) continue;
    const Converted plain = lossless(volume, Encoding::float32);
    ConversionOptions options;
    options.encoding = Encoding::automatic;
    EXPECT_TRUE(test::convert_to(volume, options, plain.file.size()).sidecar.error.lossless) << hard.name;
  }
}

TEST(QuantisedBudget, TheSmallestTreeHoldsTheCornersAtOneBit) {
  MemoryVolume volume(kDomain, [](const Index3& i) { return pseudo_random(i, 100); });
  ConversionOptions options;
  options.encoding = Encoding::float32;
  const std::uint64_t floats = test::minimum_size(volume, options);
  for (const auto& [encoding, width] : {std::pair{Encoding::automatic, LeafWidth::bits1},
                                        {Encoding::fpn, LeafWidth::bits1},
                                        {Encoding::fp4, LeafWidth::bits4},
                                        {Encoding::fp8, LeafWidth::bits8},
                                        {Encoding::fp16, LeafWidth::bits16}}) {
    options.encoding = encoding;
    const std::uint64_t minimum = test::minimum_size(volume, options);
    EXPECT_EQ(floats - minimum, 2 * (2144 - leaf_bytes(width)));
    EXPECT_EQ(test::convert_to(volume, options, minimum).sidecar.selection.leaves_kept, 2U);
    options.budget = {Budget::Kind::size, 8, minimum - 1};
    const std::string size = std::to_string(minimum);
    expect_refused(volume, options, ErrorKind::budget,
                   "out.nvdb: " + std::to_string(minimum - 1) +
                       " bytes asked, the smallest tree for this volume takes " + size + "; ask for --size " + size +
                       " or more");
  }
}

// Levels of 8 bits and more are too close to each other for float.
TEST(QuantisedBudget, DefaultOfAVolumeThatCannotReach40Decibels_IsTheRate) {
  const Box domain{{0, 0, 0}, {32, 32, 32}};
  MemoryVolume volume(
      domain, [&](const Index3& i) { return 1e-35F * std::sin(static_cast<float>(linear_index(i, domain.hi))); });
  for (const Encoding encoding : {Encoding::fpn, Encoding::fp8, Encoding::fp16}) {
    SCOPED_TRACE(encoding_name(encoding));
    ConversionOptions options;
    options.encoding = encoding;
    const Converted made = test::convert(volume, options);
    EXPECT_EQ(made.sidecar.budget.kind, "minimum");
    EXPECT_LT(made.sidecar.error.psnr_db, 40);
    ASSERT_EQ(made.notices.size(), 2U);
    EXPECT_TRUE(made.notices[1].starts_with("out.nvdb: no budget was given, and rate ")) << made.notices[1];
    EXPECT_TRUE(made.file == test::convert_to(volume, options, test::minimum_size(volume, options)).file);
    options.budget.kind = Budget::Kind::psnr;
    options.budget.target = 40;
    EXPECT_THROW(test::convert(volume, options), Error) << "asked for, it is refused";
  }
}

TEST(QuantisedBudget, KeptNonFiniteVoxelsRefuseQuantisation) {
  MemoryVolume volume(kDomain, [](const Index3& i) { return i.x == 3 ? kInf : i.y == 5 ? kNaN : 1.5F; });
  ConversionOptions options;
  options.non_finite = NonFinitePolicy::keep;
  for (const Encoding encoding : {Encoding::fpn, Encoding::fp4, Encoding::fp8, Encoding::fp16}) {
    options.encoding = encoding;
    expect_refused(volume, options, ErrorKind::usage,
                   "--encoding " + encoding_name(encoding) +
                       " holds no NaN or infinite voxels, which --nonfinite keep asks for; use --encoding float");
  }
  options.encoding = Encoding::automatic;
  const Converted best = test::convert(volume, options);
  EXPECT_EQ(best.grid().type(), GridType::float32);
  EXPECT_EQ(best.grid().value({3, 0, 0}), kInf);
  EXPECT_TRUE(std::isnan(best.grid().value({0, 5, 0})));
}

TEST(QuantisedBudget, ReplacedVoxelsAreOnTheLatticeOfTheirLeafOrWidenIt) {
  // 4 bits hold values 0 to 15 and a background of 3. A background of 1000 widens the range of its leaf.
  for (const float background : {3.0F, 1000.0F}) {
    MemoryVolume volume(kDomain, [](const Index3& i) { return i.x % 4 == 1 ? kNaN : pseudo_random(i, 16); });
    ConversionOptions options;
    options.encoding = Encoding::fpn;
    options.non_finite = NonFinitePolicy::background;
    options.background = background;
    const Converted converted = test::convert_to(volume, options, 1'000'000);
    EXPECT_EQ(converted.sidecar.nonfinite.count, 1024U);
    EXPECT_EQ(converted.grid().value({1, 2, 3}), background);
    EXPECT_EQ(converted.grid().value({0, 2, 3}), pseudo_random({0, 2, 3}, 16));
    EXPECT_TRUE(converted.sidecar.error.lossless);
    test::expect_certificate(converted, test::measure(volume, converted, NonFinitePolicy::background));
  }
}

}  // namespace
}  // namespace weir::quantised_budget_test
