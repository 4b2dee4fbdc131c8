// Tests how inputs and options expand to the volumes of a call, with the names of their output files.
#include "ingest/series.h"

#include "ingest/series_names.h"
#include "ingest/source_registry.h"
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
  // Braces in a directory's name are part of it, unless they enclose stem, dataset or step.
  EXPECT_EQ(series_outputs(steps, "run{1}/case {time} x/{stem}.nvdb"),
            (std::vector<std::string>{"run{1}/case {time} x/a_4x3x2_uint8.nvdb"}));
  EXPECT_EQ(series_outputs(steps, "out{run}/"), (std::vector<std::string>{"out{run}/a_4x3x2_uint8.nvdb"}));
}

TEST(Series, CompressedNamesLoseBothSuffixes) {
  EXPECT_EQ(expand({"head.nii.gz"})[0].stem, "head");
  EXPECT_EQ(expand({"a.b.raw"})[0].stem, "a.b");
  EXPECT_EQ(expand({"run.zarr.zip"})[0].stem, "run");
  EXPECT_EQ(expand({"HEAD.NII.GZ"})[0].stem, "HEAD");
  EXPECT_EQ(expand({"Scan.RAW.GZ"})[0].stem, "Scan");
  EXPECT_EQ(expand({"RUN.OME.ZARR.ZIP"})[0].stem, "RUN");
}

TEST(Series, DirectoriesOfZarrLoseTheirSuffix) {
  const Scratch scratch;
  for (const char* const name : {"run.zarr", "cell.ome.zarr"}) {
    std::filesystem::create_directory(scratch.path(name));
    scratch.write(std::string(name) + "/.zgroup", {});
  }
  EXPECT_EQ(expand({scratch.path("run.zarr/")})[0].stem, "run");
  EXPECT_EQ(expand({scratch.path("cell.ome.zarr")})[0].stem, "cell");
  EXPECT_EQ(series_outputs(expand({scratch.path("run.zarr")}), ""),
            (std::vector<std::string>{scratch.path("run.nvdb")}));
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

TEST(Series, ShellPattern_ExpandsToItsFilesInNaturalOrder) {
  const Scratch scratch;
  for (const char* name : {"run_9.raw", "run_10.raw", "other.raw"}) scratch.write(name, {});
  const auto steps = expand({scratch.path("run_*.raw"), scratch.path("other.raw")});
  ASSERT_EQ(steps.size(), 3U);
  EXPECT_EQ(steps[0].path, scratch.path("run_9.raw"));
  EXPECT_EQ(steps[1].path, scratch.path("run_10.raw"));
  EXPECT_EQ(steps[1].step, "");
  EXPECT_EQ(series_outputs(steps, "out/"),
            (std::vector<std::string>{"out/run_9.nvdb", "out/run_10.nvdb", "out/other.nvdb"}));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { expand({scratch.path("x*.raw")}); }),
            scratch.path("x*.raw") + ": no file has such a name; give files, or a pattern in quotes");
}

TEST(Series, Datasets_OneALine_AreAStepEach) {
  SourceOptions options;
  options.dataset = "/rho\n/fields/T";
  const auto steps = expand({"a.h5"}, options);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[1].dataset, "/fields/T");
  EXPECT_EQ(series_outputs(steps, ""), (std::vector<std::string>{"a_rho.nvdb", "a_fields.T.nvdb"}));
}

// The header lists the axes from x on. --index takes the slowest axis first.
TEST(Series, IndexChoices_AreOfTheAxesAfterTheThird) {
  const Scratch scratch;
  scratch.write("a.raw", std::vector<std::byte>(7 * 6 * 5 * 2 * 3));
  const std::string header = "NRRD0004\ntype: uchar\ndimension: 5\nsizes: 7 6 5 2 3\nencoding: raw\ndata file: a.raw\n";
  const std::string path = scratch.write("a.nrrd", std::as_bytes(std::span(header)));
  SourceOptions options;
  options.index_choices = {{{}, true, 1, {}}, {{}, false, -1, {}}};
  const auto steps = expand({path}, options);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].index, (std::vector<std::int64_t>{1, 1}));
  EXPECT_EQ(steps[1].index, (std::vector<std::int64_t>{2, 1}));
  EXPECT_EQ(series_outputs(steps, "out/"), (std::vector<std::string>{"out/a_1_1.nvdb", "out/a_2_1.nvdb"}));
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, options); }),
            path + ": --index stands for 2 volumes, and one is read here; give one position on each axis");
  options.index_choices = {{{}, false, -1, {}}, {{}, false, 0, {}}};
  EXPECT_EQ(open_source(path, options)->info().index, (std::vector<std::int64_t>{2, 0}));
  options.index_choices = {{"time", false, 0, {}}};
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, options); }),
            path + ": --index: no axis time; the array has axes without names");
}

TEST(Series, DatasetAndIndexPatternsAreRefusedForRawFiles) {
  const Scratch scratch;
  const std::string path = scratch.write("a_4x3x2_uint8.raw", std::vector<std::byte>(24));
  SourceOptions options;
  options.dataset = "/data/%d/rho";
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { expand({path}, options); }),
            path + ": --dataset with a pattern is for files that hold several volumes, and this is raw; leave it out");
  options.dataset = "";
  options.index_choices = {{{}, true, {}, {}}};
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { expand({path}, options); }),
            path + ": --index is for files that hold several volumes, and this is raw; leave it out");
}

}  // namespace
}  // namespace weir::series_test
