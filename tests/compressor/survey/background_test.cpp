#include "compressor/survey/background.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/surveyed.h"

namespace weir::background_test {
namespace {

using test::bits_of;
using test::MemoryVolume;
using test::Surveyed;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const Box kSmall{{-3, 0, 5}, {17, 20, 22}};

Background background_of(MemoryVolume& volume) {
  const Surveyed surveyed(volume);
  return find_background(surveyed.survey, surveyed.rows, volume, surveyed.plan, {});
}

Background paper_background_of(MemoryVolume& volume) {
  const Surveyed surveyed(volume);
  return paper_background(surveyed.survey, volume, surveyed.plan, {});
}

MemoryVolume volume_of(ScalarType type, const std::function<float(const Index3&)>& value) {
  MemoryVolume volume(kSmall, value);
  volume.info().type = type;
  return volume;
}

double share_of(const MemoryVolume& volume, float value) {
  const auto values = volume.values();
  const auto finite = std::count_if(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
  return static_cast<double>(std::count(values.begin(), values.end(), value)) / static_cast<double>(finite);
}

float die(const Index3& i, unsigned sides) {
  std::minstd_rand random(static_cast<unsigned>(i.x * 31 + i.y * 1009 + i.z * 65537 + 99));
  random.discard(2);
  return static_cast<float>(random() % sides);
}

TEST(Background, IsTheMostFrequentValueOfEveryType) {
  for (const ScalarType type : {ScalarType::uint8, ScalarType::int8, ScalarType::uint16, ScalarType::int16,
                                ScalarType::int32, ScalarType::uint32, ScalarType::float32, ScalarType::float64}) {
    MemoryVolume volume = volume_of(type, [](const Index3& i) { return die(i, 10) < 3 ? 42.0F : 5 + die(i * 3, 100); });
    const Background found = background_of(volume);
    EXPECT_EQ(found.value, 42);
    EXPECT_EQ(found.method, "mode");
    EXPECT_EQ(found.share, share_of(volume, 42));
  }
}

TEST(Background, OfTheSource_IsTaken) {
  MemoryVolume volume(kSmall, [](const Index3&) { return -1.5F; });
  volume.info().background = 1.5F;
  const Background found = background_of(volume);
  EXPECT_EQ(found.value, 1.5F);
  EXPECT_EQ(found.method, "source");
  EXPECT_EQ(found.share, 0);
}

TEST(Background, NegativeIntegersAreCountedToo) {
  for (const ScalarType type : {ScalarType::int8, ScalarType::int16}) {
    MemoryVolume volume = volume_of(type, [](const Index3& i) { return die(i, 4) == 0 ? die(i, 7) : -128.0F; });
    EXPECT_EQ(background_of(volume).value, -128);
  }
}

TEST(Background, TiesGoToTheLowestBinAndTheLowestValue) {
  for (const ScalarType type : {ScalarType::uint8, ScalarType::float32}) {
    // 7, 8 and 200 are equally frequent.
    MemoryVolume volume = volume_of(type, [](const Index3& i) {
      const auto at = (i.x + 3) % 4;
      return at == 0 ? 200.0F : at == 1 ? 8.0F : at == 2 ? 7.0F : 100 + static_cast<float>((i.x + 3) / 4);
    });
    EXPECT_EQ(background_of(volume).value, 7);
  }
}

TEST(Background, IsAModeOfTheFullestBinNotOfTheWhole) {
  // uint16 over its whole range has bins of 64 values. The values 64 to 127 together beat 5000 alone.
  MemoryVolume volume = volume_of(ScalarType::uint16, [](const Index3& i) {
    const float at = die(i, 10);
    return i == kSmall.lo ? 0.0F : i == kSmall.lo + Index3{1, 0, 0} ? 65535.0F : at < 3 ? 5000.0F : 64 + die(i * 5, 64);
  });
  const Background found = background_of(volume);
  EXPECT_GE(found.value, 64);
  EXPECT_LT(found.value, 128);
  EXPECT_EQ(found.share, share_of(volume, found.value));
}

TEST(Background, ZerosOfBothSignsCountTogetherAsPlusZero) {
  MemoryVolume volume = volume_of(ScalarType::float32, [](const Index3& i) {
    return die(i, 5) == 0 ? -1.0F : die(i * 7, 2) == 0 ? -0.0F : 0.0F;
  });
  const Background found = background_of(volume);
  EXPECT_EQ(bits_of(found.value), bits_of(0.0F));
  EXPECT_EQ(found.share, share_of(volume, 0));
  MemoryVolume zeros = volume_of(ScalarType::float32, [](const Index3&) { return -0.0F; });
  EXPECT_EQ(bits_of(background_of(zeros).value), bits_of(0.0F));
  EXPECT_EQ(background_of(zeros).share, 1);
}

TEST(Background, WhereNoValueOccursTwiceItIsTheMiddleOfTheFullestBin) {
  // All values are distinct: 3/4 of them are close to 10, the others are spread.
  float next = 0;
  MemoryVolume volume = volume_of(ScalarType::float32, [&](const Index3&) {
    next += 1;
    return static_cast<int>(next) % 4 == 0 ? next : 10 + next * 0x1p-18F;
  });
  const Surveyed surveyed(volume);
  const Background found = background_of(volume);
  EXPECT_EQ(found.method, "bin");
  const auto counts = surveyed.survey.histogram.counts();
  const auto most = std::max_element(counts.begin(), counts.end());
  const double width = surveyed.survey.histogram.bin_width();
  EXPECT_EQ(static_cast<double>(found.value),
            surveyed.survey.histogram.first_edge() + (static_cast<double>(most - counts.begin()) + 0.5) * width);
  EXPECT_EQ(found.share, static_cast<double>(*most) / static_cast<double>(kSmall.voxels()));
}

TEST(Background, TheMiddleOfABinStaysInTheRange) {
  // The only two voxels have two different values.
  MemoryVolume volume({{0, 0, 0}, {2, 1, 1}}, std::vector<float>{1.0F, 3e38F});
  const Background found = background_of(volume);
  EXPECT_EQ(found.method, "bin");
  EXPECT_GE(found.value, 1.0F);
  EXPECT_LE(found.value, 3e38F);
}

TEST(Background, NoFiniteValues_GiveMethodNone) {
  MemoryVolume volume = volume_of(ScalarType::float32, [](const Index3&) { return kNaN; });
  for (const Background& found : {background_of(volume), paper_background_of(volume)}) {
    EXPECT_EQ(bits_of(found.value), bits_of(0.0F));
    EXPECT_EQ(found.method, "none");
    EXPECT_EQ(found.share, 0);
  }
}

TEST(Background, NonFiniteValuesDoNotVote) {
  MemoryVolume volume = volume_of(ScalarType::float32, [](const Index3& i) {
    const float at = die(i, 10);
    return at < 6 ? kNaN : at < 8 ? std::numeric_limits<float>::infinity() : at < 9 ? 3.5F : die(i * 3, 50);
  });
  const Background found = background_of(volume);
  EXPECT_EQ(found.value, 3.5F);
  EXPECT_EQ(found.share, share_of(volume, 3.5F));
}

TEST(Background, LargeVolumesAreSampled) {
  const auto source = open_synthetic("background", {{136, 136, 136}, 1});
  MemoryVolume volume(*source);
  ASSERT_GT(source->info().domain().voxels(), kExactModeVoxels);
  const Background found = background_of(volume);
  EXPECT_EQ(found.value, 0.25F);
  EXPECT_EQ(found.method, "sampled-mode");
  EXPECT_NEAR(found.share, share_of(volume, 0.25F), 0.03);
}

TEST(Background, DoesNotDependOnTheBlocks) {
  for (const std::string kind : {"cloud", "turbulence", "ties", "negative-zero", "noise"}) {
    const auto source = open_synthetic(kind, {{140, 140, 140}, 1});
    MemoryVolume volume(*source);
    const Surveyed whole(volume);
    const Surveyed pieces(volume, 70'000, {1, 0});
    ASSERT_GT(pieces.plan.size(), 40);
    const Background a = find_background(whole.survey, whole.rows, volume, whole.plan, {});
    const Background b = find_background(pieces.survey, pieces.rows, volume, pieces.plan, {});
    EXPECT_EQ(bits_of(a.value), bits_of(b.value)) << kind;
    EXPECT_EQ(a.share, b.share) << kind;
    const Background c = paper_background(whole.survey, volume, whole.plan, {});
    const Background d = paper_background(pieces.survey, volume, pieces.plan, {});
    EXPECT_EQ(bits_of(c.value), bits_of(d.value)) << kind;
    EXPECT_EQ(c.share, d.share) << kind;
  }
}

// Returns lo + i/1023 (hi - lo) for the fullest of 1024 bins, in float, and the bin.
std::pair<float, std::size_t> paper_formula(const MemoryVolume& volume) {
  float low = std::numeric_limits<float>::max();
  float high = -low;
  for (const float v : volume.values()) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  std::array<std::size_t, 1024> counts{};
  for (const float v : volume.values()) {
    const float unit = (v - low) / (high - low);
    ++counts[static_cast<std::size_t>(unit * 1023.0F)];
  }
  const auto most = std::max_element(counts.begin(), counts.end());
  return {static_cast<float>(most - counts.begin()) / 1023.0F * (high - low) + low, *most};
}

TEST(PaperBackground, IsTheLeftEdgeOfTheFullestOfItsBins) {
  for (const ScalarType type : {ScalarType::uint8, ScalarType::int16, ScalarType::float32}) {
    MemoryVolume volume = volume_of(type, [](const Index3& i) { return die(i, 3) == 0 ? 17.0F : die(i * 3, 100); });
    const auto [value, count] = paper_formula(volume);
    const Background found = paper_background_of(volume);
    EXPECT_EQ(bits_of(found.value), bits_of(value));
    EXPECT_EQ(found.share, static_cast<double>(count) / static_cast<double>(kSmall.voxels()));
    EXPECT_EQ(found.method, "paper");
  }
  for (const std::string kind : {"cloud", "turbulence", "gradient", "offset", "tiny", "plateau", "denormal"}) {
    const auto source = open_synthetic(kind, {{40, 30, 20}, 1});
    MemoryVolume volume(*source);
    EXPECT_EQ(bits_of(paper_background_of(volume).value), bits_of(paper_formula(volume).first)) << kind;
  }
}

TEST(PaperBackground, OfOneValueIsThatValue) {
  MemoryVolume volume = volume_of(ScalarType::float32, [](const Index3&) { return -7.25F; });
  EXPECT_EQ(paper_background_of(volume).value, -7.25F);
}

TEST(PaperBackground, OfZerosOfBothSignsIsPlusZero) {
  // Otherwise the sign would be that of the zero that some thread sees first.
  for (const bool first_negative : {true, false}) {
    MemoryVolume volume = volume_of(ScalarType::float32,
                                    [&](const Index3& i) { return (i == kSmall.lo) == first_negative ? -0.0F : 0.0F; });
    EXPECT_EQ(bits_of(paper_background_of(volume).value), bits_of(0.0F));
  }
}

TEST(PaperBackground, FollowsTheFormulaWhereTheRangeOverflowsFloat) {
  MemoryVolume volume = volume_of(ScalarType::float32, [](const Index3& i) {
    const float at = die(i, 10);
    return at < 1 ? -3e38F : at < 2 ? 3e38F : at < 9 ? 1e38F : 2e38F;
  });
  const Background found = paper_background_of(volume);
  // 1e38 lies in bin floor(4/6 1023) = 682 (681.99... in exact arithmetic of the float values).
  const double unit = (static_cast<double>(1e38F) + static_cast<double>(3e38F)) / (2 * static_cast<double>(3e38F));
  const double edge = std::floor(unit * 1023) / 1023 * 2 * static_cast<double>(3e38F) - static_cast<double>(3e38F);
  EXPECT_EQ(found.value, static_cast<float>(edge));
  EXPECT_EQ(found.share, share_of(volume, 1e38F));
}

}  // namespace
}  // namespace weir::background_test
