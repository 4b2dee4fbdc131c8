// Tests a meteorologist's first hour with output of the cloud model CM1 (fields over time and a field of two axes) and
// of WRF.
#include <filesystem>

#include "tests/users/user_script.h"

namespace weir::cloud_model_test {
namespace {

class CloudModel : public UserScript {
 protected:
  void SetUp() override {
    if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
    write_inputs(R"(
n = netCDF4.Dataset("cm1_out.nc", "w")
for name, size in [("time", None), ("zh", 40), ("yh", 80), ("xh", 96)]: n.createDimension(name, size)
def coordinate(name, values, units):
    c = n.createVariable(name, "f4", (name,)); c[:] = values; c.units = units
coordinate("time", [0, 600, 1200], "seconds since 2000-01-01 00:00:00")
coordinate("zh", 0.05 * (np.arange(40) + 1) ** 1.3, "km")
coordinate("yh", np.arange(80) * 0.25, "km")
coordinate("xh", np.arange(96) * 0.25, "km")
z, y, x = np.mgrid[0:40, 0:80, 0:96]
for name in ["qc", "prs", "w"]:
    v = n.createVariable(name, "f4", ("time", "zh", "yh", "xh")); v.units = "kg/kg"; v.long_name = "field " + name
    for t in range(3): v[t] = np.exp(-((x - 40 - 8 * t) ** 2 + (y - 40) ** 2 + (z - 15) ** 2) / 200.0)
n.createVariable("rain", "f4", ("time", "yh", "xh"))[:] = 1.0
n.close()
)");
  }
};

TEST_F(CloudModel, FileOfSeveralFieldsIsAnErrorThatShowsTheCommands) {
  const CommandResult refused = weir({"convert", "cm1_out.nc"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err,
            "weir: cm1_out.nc: holds 3 volumes; choose one with --dataset: "
            "weir convert cm1_out.nc --dataset /prs --index 0 (time=3 x zh=40 x yh=80 x xh=96); "
            "weir convert cm1_out.nc --dataset /qc --index 0 (time=3 x zh=40 x yh=80 x xh=96); "
            "weir convert cm1_out.nc --dataset /w --index 0 (time=3 x zh=40 x yh=80 x xh=96)\n");
  EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"cm1_out.nc"});
}

TEST_F(CloudModel, CommandThatInspectPrintsConvertsTheFieldAndNamesIt) {
  const CommandResult inspected = weir({"inspect", "cm1_out.nc"});
  EXPECT_NE(inspected.out.find("\n  weir convert cm1_out.nc --dataset /qc --index 0\n"), std::string::npos);
  EXPECT_NE(inspected.out.find("/rain: 3 x 80 x 96 float32"), std::string::npos) << inspected.out;
  EXPECT_NE(inspected.out.find("\n  cannot be converted: 2 axes and time (time=3 x yh=80 x xh=96); a volume has three "
                               "axes of space\n"),
            std::string::npos)
      << inspected.out;

  const CommandResult made = type("weir convert cm1_out.nc --dataset /qc --index 0");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.err.find("cm1_out_qc_0.nvdb: /qc at 0, 96x80x40 voxels, "), std::string::npos) << made.err;
  EXPECT_NE(made.err.find("cm1_out.nc: /qc: axis z (zh): irregular coordinates from 0.05 to 6.0485044, taken as "
                          "indices, 1 apart; --spacing sets another distance\n"),
            std::string::npos)
      << made.err;
}

TEST_F(CloudModel, AxesInDifferentUnitsAreSaid) {
  write_inputs(R"(
n = netCDF4.Dataset("mixed.nc", "w")
for name, size in [("zh", 10), ("zm", 10), ("yh", 20), ("xh", 30), ("lat", 20), ("lon", 30)]: n.createDimension(name, size)
for name, step, units in [("zh", 100, "m"), ("yh", 1, "km"), ("xh", 1, "km"), ("lat", 1, "degrees_north"), ("lon", 1, "degrees_east")]:
    c = n.createVariable(name, "f4", (name,)); c[:] = np.arange(len(n.dimensions[name])) * step; c.units = units
c = n.createVariable("zm", "f4", ("zm",)); c[:] = np.arange(10) ** 2; c.units = "m"
for name, axes in [("a", ("zh", "yh", "xh")), ("b", ("zm", "yh", "xh")), ("c", ("zm", "lat", "lon"))]:
    n.createVariable(name, "f4", axes)[:] = 1.0
n.close()
)");
  const std::string said =
      "mixed.nc: /a: axis x (xh) is in km, y (yh) in km, z (zh) in m: positions are in different units; --spacing and "
      "--origin set them in one\n";
  const CommandResult mixed = weir({"convert", "mixed.nc", "--dataset", "a"});
  ASSERT_EQ(mixed.exit_code, 0) << mixed.err;
  EXPECT_NE(mixed.err.find(said), std::string::npos) << mixed.err;
  for (const std::vector<std::string>& one :
       {std::vector<std::string>{"--dataset", "b"}, {"--dataset", "c"}, {"--dataset", "a", "--spacing", "1,1,0.1"}}) {
    std::vector<std::string> convert{"convert", "mixed.nc", "--overwrite"};
    convert.insert(convert.end(), one.begin(), one.end());
    const CommandResult made = weir(convert);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(made.err.find("different units"), std::string::npos) << made.err;
  }
}

TEST_F(CloudModel, CommandsThatInspectPrints_MakeAFileEach) {
  EXPECT_EQ(run_printed_commands("cm1_out.nc"), 3);
  EXPECT_EQ(
      list_directory(directory_.path()),
      (std::vector<std::string>{"cm1_out.nc", "cm1_out_prs_0.nvdb", "cm1_out_prs_0.nvdb.json", "cm1_out_qc_0.nvdb",
                                "cm1_out_qc_0.nvdb.json", "cm1_out_w_0.nvdb", "cm1_out_w_0.nvdb.json"}));
}

TEST_F(CloudModel, TimesOfAField_AreFilesBesideEachOther) {
  for (const char* time : {"0", "-1", "time=1"}) {
    const CommandResult made = weir({"convert", "cm1_out.nc", "--dataset", "w", "--index", time, "-o", "out/"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }
  EXPECT_EQ(list_directory(directory_ / "out"),
            (std::vector<std::string>{"cm1_out_w_0.nvdb", "cm1_out_w_0.nvdb.json", "cm1_out_w_1.nvdb",
                                      "cm1_out_w_1.nvdb.json", "cm1_out_w_2.nvdb", "cm1_out_w_2.nvdb.json"}));
}

TEST_F(CloudModel, EveryTimeIsAFileThatKeepsItsTimeUnitsAndHeights) {
  std::filesystem::create_directory(directory_ / "nvdb");
  const CommandResult made =
      weir({"convert", "cm1_out.nc", "--dataset", "qc", "--index", "*", "--size", "400KB", "-o", "nvdb/"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  for (int t = 0; t < 3; ++t) {
    const auto source = sidecar("nvdb/cm1_out_qc_" + std::to_string(t) + ".nvdb")["source"];
    EXPECT_EQ(source["time"]["value"], 600.0 * t);
    EXPECT_EQ(source["time"]["units"], "seconds since 2000-01-01 00:00:00");
    EXPECT_EQ(source["long_name"], "field qc");
    EXPECT_EQ(source["axis_units"], (std::vector<std::string>{"km", "km", "km"}));
    EXPECT_FALSE(source["irregular_axes"].contains("x"));
    ASSERT_EQ(source["irregular_axes"]["z"].size(), 40U);
    EXPECT_NEAR(source["irregular_axes"]["z"][0], 0.05, 1e-7);
  }
  const CommandResult inspected = weir({"inspect", "nvdb/cm1_out_qc_2.nvdb"});
  EXPECT_NE(inspected.out.find("quantity    field qc (kg/kg)\n"), std::string::npos) << inspected.out;
  EXPECT_NE(inspected.out.find("time        1200 seconds since 2000-01-01 00:00:00\n"), std::string::npos);
}

// `weir watch` reads this message. Its users set keys of the configuration and type no commands.
TEST_F(CloudModel, FailureForAService_NamesKeysAndNoCommands) {
  ASSERT_EQ(type("weir convert cm1_out.nc --progress-fd 9 9>lines").exit_code, 2);
  const auto told = nlohmann::json::parse(read_file(directory_ / "lines"));
  EXPECT_EQ(told["failed"],
            "cm1_out.nc: holds 3 volumes; choose one with dataset: "
            "dataset /prs, index 0 (time=3 x zh=40 x yh=80 x xh=96); "
            "dataset /qc, index 0 (time=3 x zh=40 x yh=80 x xh=96); "
            "dataset /w, index 0 (time=3 x zh=40 x yh=80 x xh=96)");
}

TEST_F(CloudModel, MistypedAxis_IsAnsweredWithTheNamesThereAre) {
  const CommandResult refused = weir({"convert", "cm1_out.nc", "--dataset", "w", "--index", "tim=1"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err, "weir: cm1_out.nc: --index: no axis tim; /w has time, zh, yh, xh\n");
  const CommandResult space = weir({"convert", "cm1_out.nc", "--dataset", "w", "--index", "zh=1"});
  EXPECT_EQ(space.exit_code, 2);
  EXPECT_EQ(space.err, "weir: cm1_out.nc: --index names zh, an axis of the volume /w; --roi cuts along that\n");
}

TEST_F(CloudModel, NoVolumeInTheFile_NamesTheArrayThatComesNearest) {
  write_inputs(R"(
n = netCDF4.Dataset("flat.nc", "w")
for name, size in [("a", 5), ("time", 3), ("y", 8), ("x", 6), ("bare", 9)]: n.createDimension(name, size)
n.createVariable("a", "f4", ("a",))[:] = 0
t = n.createVariable("time", "f4", ("time",)); t[:] = 0; t.units = "s since 2000-01-01"
n.createVariable("k", "f4", ("bare",))[:] = 0
n.createVariable("rain", "f4", ("time", "y", "x"))[:] = 0
n.createVariable("map", "f4", ("y", "x"))[:] = 0
n.close()
)");
  const CommandResult refused = weir({"convert", "flat.nc"});
  EXPECT_EQ(refused.exit_code, 3);
  const std::string head = weir({"inspect", "flat.nc"}).out.substr(0, 40);
  EXPECT_TRUE(head.starts_with("flat.nc: hdf5, 5 datasets\n")) << head;
  EXPECT_EQ(refused.err,
            "weir: flat.nc: none of its 5 datasets is a volume; the nearest is /rain: 2 axes and time (time=3 x y=8 x "
            "x=6); a volume has three axes of space; weir inspect lists them\n");
}

TEST_F(CloudModel, PlanesOverTimeAreNoVolume) {
  const CommandResult refused = weir({"convert", "cm1_out.nc", "--dataset", "rain"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(refused.err,
            "weir: cm1_out.nc: /rain: 2 axes and time (time=3 x yh=80 x xh=96); a volume has three axes of space; to "
            "take the time for a length, give --spacing\n");
}

TEST(WrfOutput, EveryFieldOfThreeAxesIsOfferedAndTheTimeIsKept) {
  const auto published = std::filesystem::path(WEIR_SOURCE_DIR) / "../shared/data/wrf_katrina_ci_test_file.nc";
  if (!std::filesystem::exists(published)) GTEST_SKIP() << "skipped: no " << published;
  const std::string input = std::filesystem::canonical(published).string();
  const TemporaryDirectory directory;
  const CommandResult refused = run_weir({"convert", input, "-o", directory / "a.nvdb"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("choose one with --dataset: weir convert "), std::string::npos) << refused.err;
  EXPECT_EQ(refused.err.find("/RAIN"), std::string::npos) << refused.err;

  const CommandResult made = run_weir({"convert", input, "--dataset", "QCLOUD", "--index", "2", "--lossless", "--json",
                                       "-o", directory / "qcloud.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto source = nlohmann::json::parse(made.out)["source"];
  EXPECT_EQ(source["time"]["units"], "minutes since 2005-08-28 00:00:00");
  EXPECT_EQ(source["long_name"], "Cloud water mixing ratio");
  EXPECT_NE(made.err.find("qcloud.nvdb: /QCLOUD at 2, 48x48x14 voxels, "), std::string::npos) << made.err;
}

}  // namespace
}  // namespace weir::cloud_model_test
