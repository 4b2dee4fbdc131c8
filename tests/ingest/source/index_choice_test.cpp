#include "ingest/source/index_choice.h"

#include <gtest/gtest.h>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/dataset_info.h"
#include "tests/support/message_of_error.h"

namespace weir::index_choice_test {
namespace {

using Positions = std::vector<std::vector<std::int64_t>>;

const std::vector<LeadingAxis> kAxes{{"time", 4}, {"level", 3}};

std::vector<AxisChoice> parsed(const std::string& text) {
  std::vector<AxisChoice> choices;
  for (const std::string& part : split(text, ',')) choices.push_back(parse_axis_choice(part).value());
  return choices;
}

Positions positions(const std::string& text) { return chosen_positions("a.h5", kAxes, parsed(text)); }

std::string refusal(const std::string& text) {
  return message_of_error(ErrorKind::usage, [&] { positions(text); });
}

TEST(IndexChoice, Positions_CountFromEitherEnd) {
  EXPECT_EQ(positions("3,0"), (Positions{{3, 0}}));
  EXPECT_EQ(positions("-1,-3"), (Positions{{3, 0}}));
}

TEST(IndexChoice, Ranges_AreHalfOpenAndTheLastAxisChangesFirst) {
  EXPECT_EQ(positions("0:2,1"), (Positions{{0, 1}, {1, 1}}));
  EXPECT_EQ(positions(":2,1:"), (Positions{{0, 1}, {0, 2}, {1, 1}, {1, 2}}));
  EXPECT_EQ(positions("-2:,0"), (Positions{{2, 0}, {3, 0}}));
  EXPECT_EQ(positions("1:-1,0"), (Positions{{1, 0}, {2, 0}}));
  EXPECT_EQ(positions("*,0").size(), 4U);
  EXPECT_EQ(positions(":,0").size(), 4U);
}

TEST(IndexChoice, Names_MayStandInAnyOrder) {
  EXPECT_EQ(positions("level=1,time=-1"), (Positions{{3, 1}}));
  EXPECT_EQ(positions("level=*,time=0"), (Positions{{0, 0}, {0, 1}, {0, 2}}));
  const std::vector<LeadingAxis> axes{{"time", 4}, {"member", 1}};
  EXPECT_EQ(chosen_positions("a.h5", axes, parsed("time=2")), (Positions{{2, 0}})) << "one position is no choice";
}

TEST(IndexChoice, OtherTexts_AreNoChoice) {
  for (const char* text : {"", "x", "1.5", "=3", "time=", "1:x", "**", "1:2:3"}) {
    EXPECT_FALSE(parse_axis_choice(text)) << text;
  }
  EXPECT_TRUE(parse_axis_choice("3")->plain());
  for (const char* text : {"-1", "*", "0:2", "time=3"}) EXPECT_FALSE(parse_axis_choice(text)->plain()) << text;
}

TEST(IndexChoice, Choices_FitByNumberOrByName) {
  EXPECT_TRUE(choices_fit(parsed("0,0"), kAxes));
  EXPECT_TRUE(choices_fit(parsed("time=0"), kAxes));
  for (const char* text : {"0", "0,0,0", "depth=0", "time=0,1"}) EXPECT_FALSE(choices_fit(parsed(text), kAxes)) << text;
}

TEST(IndexChoice, Refusals_NameTheAxisAndItsPositions) {
  EXPECT_EQ(refusal("4,0"), "a.h5: --index has 4, and time has the positions 0 to 3, or from the end -4 to -1");
  EXPECT_EQ(refusal("0,1:4"), "a.h5: --index has 1:4, and level has the positions 0 to 2, or from the end -3 to -1");
  EXPECT_EQ(refusal("time=9223372036854775807,level=0"),
            "a.h5: --index has 9223372036854775807, and time has the positions 0 to 3, or from the end -4 to -1");
  EXPECT_EQ(refusal("2:2,0"),
            "a.h5: --index has 2:2 for time, which holds no position; give FROM:TO with FROM below TO");
  EXPECT_EQ(refusal("time=0"), "a.h5: --index says nothing of level, which has the positions 0 to 2; add level=0");
  EXPECT_EQ(refusal("time=0,time=1"), "a.h5: --index names time twice");
}

TEST(IndexChoice, AnAxisWithoutAName_IsCalledByItsPosition) {
  EXPECT_EQ(axis_name("time", 0), "time");
  EXPECT_EQ(axis_name("", 1), "axis 1");
}

TEST(IndexChoice, MoreVolumesThanACallIsFor_AreRefusedBeforeTheyAreListed) {
  const std::vector<LeadingAxis> axes{{"time", 4'000'000'000}, {"member", 2}};
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { chosen_positions("a.zarr", axes, parsed("*,*")); }),
            "a.zarr: --index stands for more than 1000000 volumes: 4000000000 along time; give ranges of positions, "
            "FIRST:END");
  EXPECT_EQ(chosen_positions("a.zarr", axes, parsed("7:10,*")).size(), 6U);
}

DatasetInfo array(const std::string& name, const std::string& obstacle = "") {
  DatasetInfo info;
  info.name = name;
  info.obstacle = obstacle;
  if (obstacle.empty()) info.index_axes = kAxes;
  return info;
}

std::string refused_index(const std::vector<DatasetInfo>& datasets, const std::string& dataset, ErrorKind kind) {
  SourceOptions options;
  options.dataset = dataset;
  options.index_choices = parsed("-1,0");
  return message_of_error(kind, [&] { index_positions("a.zarr", datasets, options); });
}

TEST(IndexChoice, ADatasetThatCannotBeRead_IsRefusedForThatReason) {
  const DatasetInfo unread = array("run/d", "has the filter 'quantize'");
  for (const char* name : {"", "run/d", "/run/d"}) {
    EXPECT_EQ(refused_index({unread}, name, ErrorKind::input), "a.zarr: run/d: has the filter 'quantize'") << name;
  }
  EXPECT_EQ(refused_index({unread, array("e")}, "run/d", ErrorKind::input), "a.zarr: run/d: has the filter 'quantize'");
}

TEST(IndexChoice, ASlashBeforeTheName_MakesNoDifference) {
  for (const char* given : {"run/d", "/run/d"}) {
    for (const char* listed : {"run/d", "/run/d"}) {
      SourceOptions options;
      options.dataset = given;
      options.index_choices = parsed("-1,0");
      EXPECT_EQ(index_positions("a", {array(listed), array("e")}, options).positions, (Positions{{3, 0}})) << given;
    }
  }
}

}  // namespace
}  // namespace weir::index_choice_test
