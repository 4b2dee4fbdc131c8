#include "ingest/series.h"

#include "tests/ingest/support/scratch.h"

namespace weir::series_test {
namespace {

std::vector<SeriesStep> expand(const std::vector<std::string>& inputs, const SourceOptions& options = {}) {
  return expand_series(inputs, options);
}

TEST(Series, AFileIsOneStep) {
  const auto steps = expand({"runs/a_4x3x2_uint8.raw"});
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].path, "runs/a_4x3x2_uint8.raw");
  EXPECT_EQ(steps[0].stem, "a_4x3x2_uint8");
  EXPECT_EQ(steps[0].step, "");
  EXPECT_EQ(series_outputs(steps, ""), (std::vector<std::string>{"runs/a_4x3x2_uint8.nvdb"}));
  EXPECT_EQ(series_outputs(steps, "b.nvdb"), (std::vector<std::string>{"b.nvdb"}));
  EXPECT_EQ(series_outputs(steps, "out/{stem}_x.nvdb"), (std::vector<std::string>{"out/a_4x3x2_uint8_x.nvdb"}));
  // What stands in braces in a directory's name is a part of it.
  EXPECT_EQ(series_outputs(steps, "run{1}/case {step} x/{stem}.nvdb"),
            (std::vector<std::string>{"run{1}/case {step} x/a_4x3x2_uint8.nvdb"}));
  EXPECT_EQ(series_outputs(steps, "out{run}/"), (std::vector<std::string>{"out{run}/a_4x3x2_uint8.nvdb"}));
}

TEST(Series, CompressedNamesLoseBothSuffixes) {
  EXPECT_EQ(expand({"head.nii.gz"})[0].stem, "head");
  EXPECT_EQ(expand({"a.b.raw"})[0].stem, "a.b");
}

TEST(Series, PatternExpandsToItsFilesInOrder) {
  const Scratch scratch;
  for (const char* name : {"run_8.raw", "run_9.raw", "run_10.raw"}) scratch.write(name, {});
  const auto steps = expand({scratch.path("run_%d.raw")});
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[0].step, "08");
  EXPECT_EQ(series_outputs(steps, "out/")[2], "out/run_10.nvdb");
  EXPECT_EQ(series_outputs(std::span(steps).first(1), "out/"),
            std::vector<std::string>{series_outputs(steps, "out/").front()});
  EXPECT_EQ(steps[2].step, "10");
  EXPECT_EQ(steps[2].path, scratch.path("run_10.raw"));
  EXPECT_EQ(series_outputs(steps, ""), (std::vector<std::string>{scratch.path("run_8.nvdb"), scratch.path("run_9.nvdb"),
                                                                 scratch.path("run_10.nvdb")}));
  EXPECT_EQ(series_outputs(steps, "t{step}.nvdb"), (std::vector<std::string>{"t08.nvdb", "t09.nvdb", "t10.nvdb"}));
}

TEST(Series, AStackIsOneStep) {
  SourceOptions options;
  options.stack = true;
  const auto steps = expand({"p/plane_%04d.raw", "p/%d.raw"}, options);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].path, "p/plane_%04d.raw");
  EXPECT_EQ(series_outputs(steps, ""), (std::vector<std::string>{"p/plane.nvdb", "p/stack.nvdb"}));
}

TEST(Series, AFileThatIsNamedLikeAPatternIsAFile) {
  const Scratch scratch;
  const std::string path = scratch.write("50%d.raw", {});
  EXPECT_EQ(expand({path})[0].path, path);
}

TEST(Series, StepsMayNotShareAName) {
  const auto steps = expand({"a/v.raw", "b/v.raw"});
  const auto refusal = [&](const std::string& output) {
    return message_of_error(ErrorKind::usage, [&] { series_outputs(steps, output); });
  };
  const std::string rest =
      ": 2 volumes, and two of them (a/v.raw and b/v.raw) would have this name; give -o a directory, or a name with "
      "{stem}, {dataset} or {step}";
  EXPECT_EQ(refusal("out.nvdb"), "out.nvdb" + rest);
  EXPECT_EQ(refusal("out/"), "out/v.nvdb" + rest);
  EXPECT_EQ(series_outputs(steps, "").size(), 2U);
}

TEST(Series, OutputNamesTakeStemDatasetAndStep) {
  const SeriesStep step{"f.h5", "/fields/a b", {3}, "f", "03"};
  EXPECT_EQ(step_name("{stem}-{dataset}-{step}{step}.nvdb", step), "f-fields.a b-0303.nvdb");
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { step_name("{time}.nvdb", step); }),
            "{time} in an output's name is not known; there are {stem}, {dataset} and {step}");
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { step_name("a{stem", step); }),
            "{stem in an output's name is not known; there are {stem}, {dataset} and {step}");
}

TEST(Series, DatasetAndIndexPatternsAreRefusedForRawFiles) {
  const Scratch scratch;
  const std::string path = scratch.write("a_4x3x2_uint8.raw", std::vector<std::byte>(24));
  SourceOptions options;
  options.dataset = "/data/%d/rho";
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { expand({path}, options); }),
            path + ": --dataset with a pattern is for files that hold several volumes, and this is raw; leave it out");
  options.dataset = "";
  options.index = {kEveryIndex};
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { expand({path}, options); }),
            path + ": --index is for files that hold several volumes, and this is raw; leave it out");
}

}  // namespace
}  // namespace weir::series_test
