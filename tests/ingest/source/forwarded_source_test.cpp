#include "ingest/source/forwarded_source.h"

#include <gtest/gtest.h>

#include "tests/ingest/support/telling_source.h"

namespace weir::forwarded_source_test {
namespace {

const Box kBox{{0, 0, 0}, {8, 8, 8}};

void expect_same(VolumeSource& source, Told& told) {
  EXPECT_EQ(source.info().extent, (Index3{16, 8, 8}));
  EXPECT_EQ(source.access().chunk, (Index3{4, 4, 4}));
  EXPECT_TRUE(source.in_memory());
  EXPECT_EQ(source.resident(), told.resident());
  EXPECT_EQ(source.places(), &told.places);
  EXPECT_EQ(source.held(kBox), &told.held);
  EXPECT_EQ(source.working_bytes(), 17U);
  EXPECT_EQ(source.bytes_read(), 18U);
  EXPECT_EQ(source.voxels_with_values(kBox), (std::vector<Box>{{{0, 0, 0}, {4, 8, 8}}}));
  const std::vector<RepeatedPart> parts = source.repeated_parts(kBox);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_TRUE(parts[0].repeats());

  std::vector<float> value(1);
  EXPECT_EQ(source.read(kBox, value).inexact, 1U);
  EXPECT_EQ(value[0], TellingSource::kRead);
  EXPECT_EQ(source.read_alone(kBox, value).inexact, 2U);
  EXPECT_EQ(value[0], TellingSource::kAlone);
  EXPECT_EQ(source.read_repeated(parts[0], value).inexact, 3U);
  EXPECT_EQ(value[0], TellingSource::kRepeated);
  EXPECT_EQ(told.asked, std::vector<Box>(6, kBox));
}

TEST(ForwardedSource, EveryCall_IsAnsweredByTheSource) {
  Told told;
  TellingSource source(told);
  ForwardedSource forwarded(source);
  expect_same(forwarded, told);
}

TEST(ForwardedSource, MayOwnItsSource) {
  Told told;
  ForwardedSource forwarded(std::make_unique<TellingSource>(told));
  expect_same(forwarded, told);
}

}  // namespace
}  // namespace weir::forwarded_source_test
