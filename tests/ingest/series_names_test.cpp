// Tests the names of output files: the words in braces, the default names, and the names that are refused.
#include "ingest/series_names.h"

#include "tests/ingest/support/scratch.h"
#include "tests/support/plotfile_writer.h"

namespace weir::series_names_test {
namespace {

using Names = std::vector<std::string>;

TEST(SeriesNames, StepsMayNotShareAName) {
  const std::vector<SeriesStep> steps{{"a/v.raw", "", {}, "v", ""}, {"b/v.raw", "", {}, "v", ""}};
  const auto refusal = [&](const std::string& output) {
    return message_of_error(ErrorKind::usage, [&] { series_outputs(steps, output); });
  };
  const std::string rest =
      ": 2 volumes, and two of them (a/v.raw and b/v.raw) would have this name; convert them one at a time, with -o "
      "NAME.nvdb";
  EXPECT_EQ(refusal("out.nvdb"), "out.nvdb" + rest);
  EXPECT_EQ(refusal("out/"), "out/v.nvdb" + rest);
  EXPECT_EQ(series_outputs(steps, "").size(), 2U);
  const std::vector<SeriesStep> volumes{{"c.nc", "/qc", {2}, "c", "2"}, {"c.nc", "/w", {2, 0}, "c", "2_0"}};
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { series_outputs(volumes, "c.nvdb"); }),
            "c.nvdb: 2 volumes, and two of them (c.nc: /qc at 2 and c.nc: /w at 2,0) would have this name; give -o a "
            "directory, with a slash at its end, or a name with {dataset} or {step}");
  const std::vector<SeriesStep> files{{"s_0.raw", "", {}, "s_0", ""}, {"s_1.raw", "", {}, "s_1", ""}};
  EXPECT_EQ(
      message_of_error(ErrorKind::usage, [&] { series_outputs(files, "c.nvdb"); }),
      "c.nvdb: 2 volumes, and two of them (s_0.raw and s_1.raw) would have this name; give -o a directory, with a "
      "slash at its end, or a name with {stem}");
}

// Slashes of a dataset's path become dots in a file's name. Neither a directory nor {dataset} thus tells `/a.b` and
// `/a/b` apart.
TEST(SeriesNames, DatasetsOfOnePart_AreToBeConvertedOneAtATime) {
  const std::vector<SeriesStep> steps{{"c.h5", "/a.b", {}, "c", ""}, {"c.h5", "/a/b", {}, "c", ""}};
  for (const auto& [output, name] :
       {std::pair("un/", "un/c_a.b.nvdb"), std::pair("{stem}_{dataset}.nvdb", "c_a.b.nvdb")}) {
    EXPECT_EQ(message_of_error(ErrorKind::usage,
                               [&, to = std::string(output)] { series_outputs(steps, to, {}, DefaultNames::of_call); }),
              cat(name,
                  ": 2 volumes, and two of them (c.h5: /a.b and c.h5: /a/b) would have this name; convert them "
                  "one at a time, with --dataset and -o NAME.nvdb"));
  }
}

TEST(SeriesNames, OfACall_SayWhatTellsItsVolumesOfAFileApart) {
  const auto names = [](const std::vector<SeriesStep>& steps) {
    return series_outputs(steps, "out/", {}, DefaultNames::of_call);
  };
  const auto of = [](const std::string& dataset, const std::string& step) {
    return SeriesStep{"a.h5", dataset, {}, "a", step};
  };
  EXPECT_EQ(names({of("/rho", "")}), Names{"out/a.nvdb"});
  EXPECT_EQ(names({of("/rho", "0"), of("/rho", "1")}), (Names{"out/a_0.nvdb", "out/a_1.nvdb"}));
  EXPECT_EQ(names({of("/0/rho", "0"), of("/1/rho", "1")}), (Names{"out/a_0.nvdb", "out/a_1.nvdb"}));
  EXPECT_EQ(names({of("/rho", ""), of("/fields/T", "")}), (Names{"out/a_rho.nvdb", "out/a_fields.T.nvdb"}));
  EXPECT_EQ(names({of("/rho", "0"), of("/rho", "1"), of("/T", "0"), of("/T", "1")}),
            (Names{"out/a_rho_0.nvdb", "out/a_rho_1.nvdb", "out/a_T_0.nvdb", "out/a_T_1.nvdb"}));
  EXPECT_EQ(names({of("/rho", ""), {"b.h5", "/rho", {}, "b", ""}}), (Names{"out/a.nvdb", "out/b.nvdb"}))
      << "another file's volumes have its stem";
}

TEST(SeriesNames, OutputNamesTakeStemDatasetAndStep) {
  const SeriesStep step{"f.h5", "/fields/a b", {3}, "f", "03"};
  EXPECT_EQ(step_name("{stem}-{dataset}-{step}{step}.nvdb", step), "f-fields.a b-0303.nvdb");
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { step_name("{time}.nvdb", step); }),
            "{time} in an output's name is not known; there are {stem}, {dataset} and {step}");
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { step_name("a{stem", step); }),
            "{stem in an output's name is not known; there are {stem}, {dataset} and {step}");
}

TEST(SeriesNames, WordsThatLeaveNothingBeforeTheExtension_AreRefused) {
  const std::vector<SeriesStep> one{{"in/a.raw", "", {}, "a", ""}};
  const auto refusal = [&](const std::string& output) {
    return message_of_error(ErrorKind::usage, [&] { series_outputs(one, output); });
  };
  EXPECT_EQ(refusal("e/{dataset}.nvdb"),
            "-o e/{dataset}.nvdb: in/a.raw has no {dataset}, so the name would be .nvdb; use {stem} or a plain name");
  EXPECT_EQ(refusal("e/{dataset}"),
            "-o e/{dataset}: in/a.raw has no {dataset}, so there would be no name; use {stem} or a plain name");
  EXPECT_EQ(series_outputs(one, "e/t{dataset}.nvdb"), Names{"e/t.nvdb"});
}

TEST(SeriesNames, StepOfAVolumeWithoutOne_IsRefused) {
  const std::vector<SeriesStep> files{{"s_0.raw", "", {}, "s_0", ""}, {"s_1.raw", "", {}, "s_1", ""}};
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}}) {
    for (const std::string output : {"gl_{step}.nvdb", "{step}.nvdb", "out/{stem}_{step}.nvdb", "out/{step}"}) {
      EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { series_outputs(std::span(files).first(count), output); }),
                cat("-o ", output,
                    ": s_0.raw has no {step}: a pattern with %d, 'run_%d.raw', or a range of --index gives one, * and "
                    "lists do not; use {stem}, or such a pattern"));
    }
  }
  EXPECT_EQ(series_outputs(std::vector<SeriesStep>{{"a.raw", "", {}, "a", "7"}}, "{step}.nvdb"), Names{"7.nvdb"});
}

TEST(SeriesNames, WordsInADirectorysName_AreRefused) {
  const std::vector<SeriesStep> one{{"a.raw", "", {}, "a", "7"}};
  const auto refusal = [&](const std::string& output) {
    return message_of_error(ErrorKind::usage, [&] { series_outputs(one, output); });
  };
  const std::string rest =
      " stands for something in a file's name only, and this is a directory's; give DIRECTORY/{stem}.nvdb, or "
      "DIRECTORY/ alone";
  EXPECT_EQ(refusal("fr_{step}/"), "-o fr_{step}/: {step}" + rest);
  EXPECT_EQ(refusal("run/{stem}/x_{step}.nvdb"), "-o run/{stem}/x_{step}.nvdb: {stem}" + rest);
  EXPECT_EQ(series_outputs(one, "run{1}/{stem}.nvdb"), Names{"run{1}/a.nvdb"}) << "other braces are its own";
}

// The name is the stem alone if the file holds one volume, or if it cannot be listed.
TEST(SeriesNames, OfAFileThatHoldsOneVolume_AreItsStem) {
  const Scratch scratch;
  scratch.write("a.raw", std::vector<std::byte>(4 * 3 * 2));
  const std::string header = "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 4 3 2 1\nencoding: raw\ndata file: a.raw\n";
  const std::string path = scratch.write("a.nrrd", std::as_bytes(std::span(header)));
  EXPECT_EQ(series_outputs(std::vector<SeriesStep>{{path, "", {}, "a", ""}}, "out/"), Names{"out/a.nvdb"});
  EXPECT_EQ(series_outputs(std::vector<SeriesStep>{{path, "", {0}, "a", ""}}, "out/"), Names{"out/a.nvdb"})
      << "an axis of one position leaves no choice";
  EXPECT_EQ(series_outputs(std::vector<SeriesStep>{{scratch.path("none.h5"), "/rho", {}, "none", ""}}, "out/"),
            Names{"out/none.nvdb"});
}

TEST(SeriesNames, OfAPlotfileNamedByItsHeader_LieBesideIt) {
  EXPECT_EQ(series_outputs(std::vector<SeriesStep>{{"run/plt00042/Header", "", {}, "plt00042", ""}}, ""),
            Names{"run/plt00042.nvdb"});
}

TEST(SeriesNames, OfAPositionChosen_HasItWithZerosBefore) {
  const Scratch scratch;
  scratch.write("a.raw", std::vector<std::byte>(4 * 3 * 2 * 5 * 12));
  const std::string header =
      "NRRD0004\ntype: uchar\ndimension: 5\nsizes: 4 3 2 5 12\nencoding: raw\ndata file: a.raw\n";
  const std::string path = scratch.write("a.nrrd", std::as_bytes(std::span(header)));
  EXPECT_EQ(series_outputs(std::vector<SeriesStep>{{path, "", {3, 4}, "a", ""}}, "out/"), Names{"out/a_03_4.nvdb"});
}

TEST(SeriesNames, OfALevelChosen_HaveIt) {
  const Scratch scratch;
  const std::string path = scratch.path("plt7");
  test::PlotfilePlan plan;
  plan.ratios = {{2, 2, 2}};
  plan.boxes.push_back({Box{{0, 0, 0}, {8, 8, 8}}});
  test::write_plotfile(path, plan);
  const std::vector<SeriesStep> one{{path, "", {}, "plt7", ""}};
  SourceOptions options;
  EXPECT_EQ(series_outputs(one, "out/", options), Names{"out/plt7.nvdb"});
  options.level = 0;
  EXPECT_EQ(series_outputs(one, "out/", options), Names{"out/plt7_level0.nvdb"});
}

TEST(SeriesNames, OfAMagnitude_HaveItsComponents) {
  const Scratch scratch;
  const std::string path = scratch.path("plt7");
  test::PlotfilePlan plan;
  plan.components = {"u", "v", "w"};
  test::write_plotfile(path, plan);
  SourceOptions options;
  options.magnitude = {"u", "v", "w"};
  EXPECT_EQ(series_outputs(std::vector<SeriesStep>{{path, "", {}, "plt7", ""}}, "out/", options),
            Names{"out/plt7_u_v_w_magnitude.nvdb"});
}

}  // namespace
}  // namespace weir::series_names_test
