#include "compressor/survey/survey.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "compressor/leaf/leaf_summary.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/compressor/support/surveyed.h"

namespace weir::survey_test {
namespace {

using test::MemoryVolume;
using test::Surveyed;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
const Box kDomain{{-13, 5, 120}, {40, 30, 141}};

TEST(Survey, EveryRowIsTheSummaryOfItsLeaf) {
  MemoryVolume volume(
      kDomain, [](const Index3& i) { return static_cast<float>(i.x) * 0.7F + static_cast<float>(i.y * i.z) * 1e-3F; });
  const Surveyed surveyed(volume);
  const NodeLattice& leaves = surveyed.rows.leaves();
  const std::vector<LeafRow> rows = surveyed.all_rows();
  ASSERT_EQ(std::ssize(rows), leaves.size());
  for (std::int64_t i = 0; i < leaves.size(); ++i) {
    const std::vector<float> values = volume.in(leaves.voxels(leaves.position(i)));
    const LeafRow expected = summarize_leaf(values, sample_position(i, values.size()));
    EXPECT_EQ(std::memcmp(&rows[static_cast<std::size_t>(i)], &expected, sizeof expected), 0) << i;
  }
}

TEST(Survey, CountsFiniteValuesAndFindsTheFirstOther) {
  MemoryVolume volume(kDomain, [](const Index3& i) {
    const Index3 at = i - kDomain.lo;
    return at == Index3{9, 3, 1}    ? kNaN
           : at == Index3{2, 4, 1}  ? kInf
           : at == Index3{52, 2, 1} ? -kInf
           : at == Index3{0, 0, 20} ? kNaN
                                    : static_cast<float>(at.x);
  });
  for (const std::uint64_t block_bytes : {std::uint64_t{1} << 30U, std::uint64_t{20'000}, std::uint64_t{2'048}}) {
    const Surveyed surveyed(volume, block_bytes, {1, 0});
    EXPECT_EQ(surveyed.survey.non_finite, 4U);
    EXPECT_EQ(surveyed.survey.finite, static_cast<std::uint64_t>(kDomain.voxels()) - 4);
    EXPECT_EQ(surveyed.survey.first_non_finite, (kDomain.lo + Index3{52, 2, 1}));
    EXPECT_EQ(surveyed.survey.first_non_finite_value, -kInf);
    EXPECT_EQ(surveyed.survey.min, 0);
    EXPECT_EQ(surveyed.survey.max, 52);
  }
}

TEST(Survey, NoFiniteValues_GiveAZeroRange) {
  MemoryVolume volume(kDomain, [](const Index3&) { return -kInf; });
  const Surveyed surveyed(volume);
  EXPECT_EQ(surveyed.survey.finite, 0U);
  EXPECT_EQ(surveyed.survey.min, 0);
  EXPECT_EQ(surveyed.survey.max, 0);
  EXPECT_TRUE(surveyed.survey.histogram.empty());
}

TEST(Survey, SmallIntegersAreCountedOneByOne) {
  struct Type {
    ScalarType type;
    int low;
    int high;
  };
  for (const Type& t : {Type{ScalarType::uint8, 0, 255}, Type{ScalarType::int8, -128, 127},
                        Type{ScalarType::uint16, 0, 65535}, Type{ScalarType::int16, -32768, 32767}}) {
    std::mt19937 random(2);
    MemoryVolume volume(kDomain, [&](const Index3& i) {
      if (i == kDomain.lo) return static_cast<float>(t.low);
      if (i.x < 3) return static_cast<float>(t.high);  // whole leaves of one value too
      return static_cast<float>(t.low + static_cast<int>(random() % static_cast<unsigned>(t.high - t.low + 1)));
    });
    volume.info().type = t.type;
    const Surveyed surveyed(volume);
    const Survey& survey = surveyed.survey;
    ASSERT_EQ(survey.value_offset, t.low);
    std::vector<std::uint64_t> expected(static_cast<std::size_t>(t.high - t.low) + 1);
    for (const float v : volume.values()) ++expected[static_cast<std::size_t>(static_cast<int>(v) - t.low)];
    EXPECT_EQ(survey.value_counts, expected);
    RangeHistogram histogram;
    for (const float v : volume.values()) histogram.add(v, 1);
    EXPECT_EQ(survey.histogram.counts(), histogram.counts());
    EXPECT_EQ(survey.histogram.first_edge(), histogram.first_edge());
    EXPECT_EQ(survey.min, static_cast<float>(t.low));
    EXPECT_EQ(survey.max, static_cast<float>(t.high));
  }
}

TEST(Survey, DoesNotDependOnTheBlocks) {
  for (const std::string kind : {"cloud", "some-nan", "denormal", "huge", "noise", "plateau"}) {
    const auto source = open_synthetic(kind, {{70, 50, 40}, 4});
    MemoryVolume volume(*source);
    const Surveyed whole(volume);
    for (const std::uint64_t block_bytes : {std::uint64_t{2'048}, std::uint64_t{9'000}, std::uint64_t{150'000}}) {
      const Surveyed pieces(volume, block_bytes, {1, 0});
      const auto a = whole.all_rows();
      const auto b = pieces.all_rows();
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(LeafRow)), 0) << kind;
      EXPECT_EQ(whole.survey.histogram.counts(), pieces.survey.histogram.counts()) << kind;
      EXPECT_EQ(whole.survey.histogram.first_edge(), pieces.survey.histogram.first_edge()) << kind;
      EXPECT_EQ(source_digest(whole.rows), source_digest(pieces.rows)) << kind;
    }
  }
}

TEST(Survey, SourceDigestSeesEveryBit) {
  MemoryVolume zeros(kDomain, [](const Index3&) { return 0.0F; });
  MemoryVolume one_negative(kDomain, [](const Index3& i) { return i == Index3{0, 10, 130} ? -0.0F : 0.0F; });
  EXPECT_NE(source_digest(Surveyed(zeros).rows), source_digest(Surveyed(one_negative).rows));
  EXPECT_EQ(source_digest(Surveyed(zeros).rows).size(), 32U);
}

}  // namespace
}  // namespace weir::survey_test
