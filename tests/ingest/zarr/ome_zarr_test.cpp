#include "ingest/series.h"
#include "ingest/series_names.h"
#include "ingest/zarr/zarr_source.h"
#include "tests/ingest/zarr/support/zarr_files.h"

namespace weir::ome_zarr_test {
namespace {

constexpr const char* kImage =
    R"([{"axes":[{"name":"t","type":"time","unit":"second"},{"name":"c","type":"channel"},)"
    R"({"name":"z","type":"space","unit":"micrometer"},{"name":"y","type":"space","unit":"micrometer"},)"
    R"({"name":"x","type":"space","unit":"micrometer"}],"datasets":[)"
    R"({"path":"0","coordinateTransformations":[{"type":"scale","scale":[1,1,0.5,0.25,0.25]},)"
    R"({"type":"translation","translation":[0,0,3,2,1]}]},)"
    R"({"path":"1","coordinateTransformations":[{"type":"scale","scale":[1,1,1,0.5,0.5]}]}],)"
    R"("coordinateTransformations":[{"type":"scale","scale":[0.1,1,2,2,2]}]}])";

/// Writes an image of two levels, 2 times and 1 channel: OME-Zarr 0.5 in Zarr 3 if `v3`, otherwise 0.4 in Zarr 2.
void write_image(const ZarrFiles& files, bool v3) {
  if (v3) {
    files.write("zarr.json", cat(R"({"zarr_format":3,"node_type":"group","attributes":{"ome":{"version":"0.5",)",
                                 R"("multiscales":)", kImage, "}}}"));
    files.write("0/zarr.json", zarr_json("[2,1,2,2,2]", "[1,1,2,2,2]", R"([{"name":"bytes"}])", "uint8", "1"));
    files.write("1/zarr.json", zarr_json("[2,1,1,1,1]", "[1,1,1,1,1]", R"([{"name":"bytes"}])", "uint8", "2"));
  } else {
    files.write(".zgroup", R"({"zarr_format":2})");
    files.write(".zattrs", cat(R"({"multiscales":)", kImage, "}"));
    files.write("0/.zarray", zarray("[2,1,2,2,2]", "[1,1,2,2,2]", "|u1", "1"));
    files.write("1/.zarray", zarray("[2,1,1,1,1]", "[1,1,1,1,1]", "|u1", "2"));
    // The labels are an image of their own.
    files.write("labels/.zgroup", R"({"zarr_format":2})");
    files.write("labels/cells/.zgroup", R"({"zarr_format":2})");
    files.write("labels/cells/.zattrs", R"({"multiscales":[{"axes":["z","y","x"],"datasets":[{"path":"0"}]}]})");
    files.write("labels/cells/0/.zarray", zarray("[1,1,1]", "[1,1,1]", "|u1", "3"));
  }
}

TEST(OmeZarr, FinestLevelIsRead_WithItsSpacingOriginUnitsAndTime) {
  for (const bool v3 : {false, true}) {
    const ZarrFiles files;
    write_image(files, v3);
    SourceOptions options;
    options.index = {1, 0};
    const auto source = open_source(files.path(), options);
    const SourceInfo& info = source->info();
    EXPECT_EQ(info.dataset, "0");
    EXPECT_EQ(info.extent, (Index3{2, 2, 2}));
    EXPECT_EQ(info.spacing, (std::array{0.5, 0.5, 1.0}));
    EXPECT_EQ(info.origin, (std::array{2.0, 4.0, 6.0}));
    EXPECT_EQ(info.axis_labels, (std::array<std::string, 3>{"x", "y", "z"}));
    EXPECT_EQ(info.details.axes[2].units, "micrometer");
    ASSERT_TRUE(info.details.time);
    EXPECT_EQ(info.details.time->value, 0.1);
    EXPECT_EQ(info.details.time->units, "second");
    EXPECT_EQ(ZarrFiles::read_all(*source), std::vector<float>(8, 1.0F));
    options.index.clear();
    options.index_choices = {*parse_axis_choice("t=-1")};
    EXPECT_EQ(open_source(files.path(), options)->info().index, (std::vector<std::int64_t>{1, 0}));
  }
}

TEST(OmeZarr, LevelNamedByItsOwnPath_LiesWhereTheImageSaysIt) {
  for (const bool v3 : {false, true}) {
    const ZarrFiles files;
    write_image(files, v3);
    for (const std::string end : {"", "/", v3 ? "/zarr.json" : "/.zarray"}) {
      SourceOptions options;
      options.index_choices = {*parse_axis_choice("t=1"), *parse_axis_choice("c=0")};
      const auto source = open_source(files.path("1") + end, options);
      const SourceInfo& info = source->info();
      EXPECT_EQ(info.dataset, "");
      EXPECT_EQ(info.spacing, (std::array{1.0, 1.0, 2.0})) << end;
      EXPECT_EQ(info.details.axes[2].units, "micrometer");
      ASSERT_TRUE(info.details.time);
      EXPECT_EQ(info.details.time->value, 0.1);
      EXPECT_EQ(ZarrFiles::read_all(*source), std::vector<float>{2});
    }
    const std::vector<DatasetInfo> listed = list_zarr(files.path("1"), {});
    ASSERT_EQ(listed.size(), 1U);
    EXPECT_FALSE(listed[0].by_name_only) << "there is no other";
    EXPECT_EQ(listed[0].axis_names, (std::vector<std::string>{"t", "c", "z", "y", "x"}));
  }
}

TEST(OmeZarr, DefaultNames_HaveThePositionsThatWereChosen) {
  for (const bool v3 : {false, true}) {
    const ZarrFiles files;
    write_image(files, v3);
    const auto names = [&](const std::string& index, const std::string& dataset = "") {
      SourceOptions options;
      options.dataset = dataset;
      for (const std::string& choice : split(index, ',')) options.index_choices.push_back(*parse_axis_choice(choice));
      std::vector<std::string> found;
      for (const std::string& path :
           series_outputs(expand_series(std::vector{files.path()}, options), "out/", options)) {
        found.push_back(std::filesystem::path(path).filename());
      }
      return found;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(names("t=0"), Names{"run_0.nvdb"});
    EXPECT_EQ(names("t=-1,c=0"), Names{"run_1.nvdb"}) << "the one channel leaves no choice";
    EXPECT_EQ(names("1,0", "1"), Names{"run_1_1.nvdb"}) << "a coarser scale, and its time";
    EXPECT_EQ(names("t=*"), (Names{"run_0.nvdb", "run_1.nvdb"}));
  }
}

TEST(OmeZarr, OtherLevelsAndLabels_AreReadByName) {
  const ZarrFiles files;
  write_image(files, false);
  SourceOptions options;
  options.dataset = "1";
  options.index = {0, 0};
  const auto source = open_source(files.path(), options);
  EXPECT_EQ(source->info().spacing, (std::array{1.0, 1.0, 2.0}));
  EXPECT_EQ(source->info().origin, (std::array{0.0, 0.0, 0.0}));
  EXPECT_EQ(ZarrFiles::read_all(*source), (std::vector<float>{2}));
  options.index.clear();
  for (const char* const name : {"labels/cells", "labels/cells/0"}) {
    options.dataset = name;
    EXPECT_EQ(files.read(options), (std::vector<float>{3})) << name;
  }
}

TEST(OmeZarr, SlashesAtTheEndsOfAPath_AreNoPartOfIt) {
  for (const char* const path : {"0/", "/0", "//0//"}) {
    const ZarrFiles files;
    files.write(".zgroup", R"({"zarr_format":2})");
    files.write(".zattrs",
                cat(R"({"multiscales":[{"axes":[{"name":"z","type":"space","unit":"micrometer"},"y","x"],)",
                    R"("datasets":[{"path":")", path, R"(","coordinateTransformations":[)",
                    R"({"type":"scale","scale":[4,3,2]},{"type":"translation","translation":[7,6,5]}]}]}]})"));
    files.write("0/.zarray", zarray("[1,1,1]", "[1,1,1]"));
    for (const char* const dataset : {"", "0"}) {
      SourceOptions options;
      options.dataset = dataset;
      const auto source = open_source(files.path(), options);
      const SourceInfo& info = source->info();
      EXPECT_EQ(info.dataset, "0") << path;
      EXPECT_EQ(info.spacing, (std::array{2.0, 3.0, 4.0})) << path;
      EXPECT_EQ(info.origin, (std::array{5.0, 6.0, 7.0})) << path;
      EXPECT_EQ(info.axis_labels, (std::array<std::string, 3>{"x", "y", "z"})) << path;
      EXPECT_EQ(info.details.axes[2].units, "micrometer") << path;
    }
  }
}

TEST(OmeZarr, Inspect_ListsLevelsWithAxesAndPlace) {
  const ZarrFiles files;
  write_image(files, true);
  const std::vector<DatasetInfo> list = list_zarr(files.path(), {});
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].name, "0");
  EXPECT_EQ(list[0].leading_axes, 2U);
  EXPECT_EQ(list[0].axis_names, (std::vector<std::string>{"t", "c", "z", "y", "x"}));
  const std::vector<std::pair<std::string, std::string>> attributes{{"axes", "t 2, c 1, z 2, y 2, x 2"},
                                                                    {"fill value", "1"},
                                                                    {"spacing x,y,z", "0.5,0.5,1"},
                                                                    {"origin x,y,z", "2,4,6"},
                                                                    {"unit of space", "micrometer"}};
  EXPECT_EQ(list[0].attributes, attributes);
}

TEST(OmeZarr, PlanesOverTime_AreNoVolume) {
  const ZarrFiles files;
  files.write(".zgroup", R"({"zarr_format":2})");
  files.write(".zattrs", R"({"multiscales":[{"axes":[{"name":"c","type":"channel"},{"name":"y","type":"space"},)"
                         R"({"name":"x","type":"space"}],"datasets":[{"path":"0"}]}]})");
  files.write("0/.zarray", zarray("[3,4,5]", "[3,4,5]"));
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/0: 2 axes of space at its end (c 3, y 4, x 5); a volume has three");
}

TEST(OmeZarr, AxisTOfAVersionThatHasNamesAlone_IsATimeOfNoValue) {
  const ZarrFiles files;
  const auto write = [&](std::string_view axes, std::string_view shape) {
    files.write(".zgroup", R"({"zarr_format":2})");
    files.write(".zattrs", cat(R"({"multiscales":[{"axes":)", axes, R"(,"datasets":[{"path":"0"}]}]})"));
    files.write("0/.zarray", zarray(shape, shape));
  };
  write(R"(["t","y","x"])", "[3,4,5]");
  EXPECT_EQ(files.message(ErrorKind::input),
            "run.zarr/0: 2 axes of space and a time at its end (t 3, y 4, x 5); a volume has three of space; to take "
            "the time for a length, give --spacing");
  write(R"(["t","z","y","x"])", "[2,3,4,5]");
  SourceOptions options;
  options.index = {1};
  const auto source = open_source(files.path(), options);
  EXPECT_EQ(source->info().extent, (Index3{5, 4, 3}));
  EXPECT_FALSE(source->info().details.time);
}

TEST(OmeZarr, ScaleOfZero_IsRefusedByTheDocumentThatSaysIt) {
  for (const bool v3 : {false, true}) {
    const ZarrFiles files;
    const std::string image = R"("multiscales":[{"axes":["z","y","x"],"datasets":[{"path":"0",)"
                              R"("coordinateTransformations":[{"type":"scale","scale":[1,0,1]}]}]}])";
    if (v3) {
      files.write("zarr.json", cat(R"({"zarr_format":3,"node_type":"group","attributes":{"ome":{)", image, "}}}"));
      files.write("0/zarr.json", zarr_json("[1,1,1]", "[1,1,1]"));
    } else {
      files.write(".zgroup", R"({"zarr_format":2})");
      files.write(".zattrs", cat("{", image, "}"));
      files.write("0/.zarray", zarray("[1,1,1]", "[1,1,1]"));
    }
    EXPECT_EQ(files.message(ErrorKind::input),
              cat("run.zarr: 0: its spacing has 0 (coordinateTransformations in ", v3 ? "zarr.json" : ".zattrs",
                  "), which is not finite and above 0; give --spacing x,y,z"));
  }
}

TEST(OmeZarr, FinestLevelPlacedInAnotherWay_IsReadAndNotTheNextOne) {
  const std::string note =
      "its coordinateTransformations are others than scale and translation by numbers, taken as indices";
  for (const char* transformation : {R"({"type":"affine","affine":[[1,0,0,0],[0,1,0,0],[0,0,1,0]]})",
                                     R"({"type":"scale","path":"scales"})", R"({"type":"scale","scale":["2",1,1]})"}) {
    const ZarrFiles files;
    files.write(".zgroup", R"({"zarr_format":2})");
    files.write(".zattrs",
                cat(R"({"multiscales":[{"axes":["z","y","x"],"datasets":[{"path":"0","coordinateTransformations":[)",
                    R"({"type":"scale","scale":[2,2,2]},)", transformation, R"(]},{"path":"1",)",
                    R"("coordinateTransformations":[{"type":"scale","scale":[4,4,4]}]}]}]})"));
    files.write("0/.zarray", zarray("[2,2,2]", "[2,2,2]", "|u1", "1"));
    files.write("1/.zarray", zarray("[1,1,1]", "[1,1,1]", "|u1", "2"));
    const auto source = open_source(files.path(), {});
    EXPECT_EQ(source->info().dataset, "0") << transformation;
    EXPECT_EQ(source->info().spacing, (std::array{1.0, 1.0, 1.0}));
    for (const AxisDetails& axis : source->info().details.axes) EXPECT_EQ(axis.note, note);
    EXPECT_EQ(list_zarr(files.path(), {})[0].attributes.back(), (std::pair<std::string, std::string>{"note", note}));
  }
}

TEST(OmeZarr, ListsOfAnotherLengthThanTheAxes_AreSaidAndNotApplied) {
  const std::string begin = "its coordinateTransformations are others than scale and translation by ";
  const std::string by_rank = begin + "3 numbers, one for each axis, taken as indices";
  const std::string by_numbers = begin + "numbers, taken as indices";
  for (const auto& [transformations, note] :
       {std::pair(R"({"type":"scale","scale":[2,2]})", by_rank),
        std::pair(R"({"type":"scale","scale":[1,2,2,2]},{"type":"translation","translation":[0,5,5,5]})", by_rank),
        std::pair(R"({"type":"translation","translation":[5,5]})", by_rank),
        std::pair(R"({"type":"scale","scale":[2,2,2]},{"type":"translation","translation":[5,5]})", by_numbers),
        std::pair(R"({"type":"scale","scale":[2,2]},{"type":"translation","translation":[5,5,5]})", by_numbers)}) {
    const ZarrFiles files;
    files.write(".zgroup", R"({"zarr_format":2})");
    files.write(".zattrs",
                cat(R"({"multiscales":[{"axes":["z","y","x"],"datasets":[{"path":"0","coordinateTransformations":[)",
                    transformations, "]}]}]}"));
    files.write("0/.zarray", zarray("[2,2,2]", "[2,2,2]", "|u1", "1"));
    const auto source = open_source(files.path(), {});
    EXPECT_EQ(source->info().spacing, (std::array{1.0, 1.0, 1.0})) << transformations;
    EXPECT_EQ(source->info().origin, (std::array{0.0, 0.0, 0.0})) << transformations;
    for (const AxisDetails& axis : source->info().details.axes) EXPECT_EQ(axis.note, note) << transformations;
  }
}

TEST(OmeZarr, ScaleThatIsNoSpacing_IsRefused) {
  const ZarrFiles files;
  files.write(".zgroup", R"({"zarr_format":2})");
  files.write(".zattrs", R"({"multiscales":[{"axes":["z","y","x"],"datasets":[{"path":"0","coordinateTransformations":)"
                         R"([{"type":"scale","scale":[1,0,1]}]}]}]})");
  files.write("0/.zarray", zarray("[1,1,1]", "[1,1,1]"));
  const std::string message = files.message(ErrorKind::input);
  EXPECT_NE(message.find("spacing"), std::string::npos) << message;
  SourceOptions options;
  options.spacing = {1, 1, 1};
  EXPECT_EQ(files.read(options), (std::vector<float>{7}));
}

}  // namespace
}  // namespace weir::ome_zarr_test
