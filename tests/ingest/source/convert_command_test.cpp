#include "ingest/source/convert_command.h"

#include <gtest/gtest.h>

namespace weir::convert_command_test {
namespace {

TEST(ConvertCommand, IsQuotedForAShell) {
  DatasetInfo dataset;
  dataset.name = "/it's";
  dataset.leading_axes = 2;
  EXPECT_EQ(convert_command("runs/a b.h5", true, dataset),
            "weir convert 'runs/a b.h5' --dataset '/it'\\''s' --index 0,0");
  EXPECT_EQ(convert_command("a.nrrd", false, {}), "weir convert a.nrrd");
}

TEST(ConvertCommand, NamesAnAxisThatIsNoLeadingOne) {
  DatasetInfo dataset;
  dataset.name = "/v";
  dataset.leading_axes = 1;
  dataset.index_axes = {{"time", 4}};
  EXPECT_EQ(convert_command("a.h5", true, dataset), "weir convert a.h5 --dataset /v --index 0");
  dataset.index_by_name = true;
  EXPECT_EQ(convert_command("a.h5", true, dataset), "weir convert a.h5 --dataset /v --index time=0");
}

TEST(VolumeKeys, NameAnAxisThatIsNoLeadingOne) {
  DatasetInfo dataset;
  dataset.name = "/v";
  dataset.leading_axes = 2;
  dataset.index_axes = {{"time", 4}, {"member", 2}};
  EXPECT_EQ(volume_keys(dataset), "dataset /v, index 0,0");
  dataset.index_by_name = true;
  EXPECT_EQ(volume_keys(dataset), "dataset /v, index time=0,member=0");
}

TEST(ConvertCommand, ChoosesTheMagnitudeOfVectorsAndOneNumberOfTensors) {
  DatasetInfo dataset;
  dataset.name = "/v";
  dataset.components = 3;
  EXPECT_EQ(convert_command("a.h5", true, dataset), "weir convert a.h5 --dataset /v --component magnitude");
  dataset.components = 9;
  EXPECT_EQ(convert_command("a.h5", true, dataset), "weir convert a.h5 --dataset /v --component 0");
}

TEST(VolumeKeys, AreTheSameChoiceForAConfiguration) {
  DatasetInfo dataset;
  dataset.name = "/it's a";
  EXPECT_EQ(volume_keys(dataset), "dataset /it's a");
  dataset.leading_axes = 2;
  dataset.components = 3;
  EXPECT_EQ(volume_keys(dataset), "dataset /it's a, index 0,0, component magnitude");
}

}  // namespace
}  // namespace weir::convert_command_test
