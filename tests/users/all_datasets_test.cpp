// Tests the conversion of all datasets of a model's file with fields of several shapes. A message names each dataset
// that the options do not convert, and the option that would convert it.
#include "tests/users/user_script.h"

namespace weir::all_datasets_test {
namespace {

class AllDatasets : public UserScript {
 protected:
  void SetUp() override {
    if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
    write_inputs(R"(
n = netCDF4.Dataset("all.nc", "w")
for name, size in [("time", 2), ("z", 8), ("y", 24), ("x", 30), ("zs", 6), ("component", 3)]: n.createDimension(name, size)
z, y, x = np.mgrid[0:8, 0:24, 0:30]
field = np.sin(x / 5.0) + np.cos(y / 3.0) * z
n.createVariable("qc", "f4", ("time", "z", "y", "x"))[:] = np.stack([field, -field])
n.createVariable("rho", "f4", ("z", "y", "x"))[:] = field
n.createVariable("soil", "f4", ("zs", "y", "x"))[:] = field[:6]
n.createVariable("vel", "f4", ("z", "y", "x", "component"))[:] = np.stack([field, field, -field], axis=-1)
n.createVariable("rain", "f4", ("time", "y", "x"))[:] = 1.0
n.close()
)");
  }
};

constexpr const char* kSeries =
    "all.nc: left out: /qc: it has the leading axis time of 2; give --index with 1 position\n";
constexpr const char* kVectors = "all.nc: left out: /vel: each of its voxels has 3 components; give --component\n";

TEST_F(AllDatasets, VolumesAreConvertedAndTheOthersNamed) {
  for (const std::vector<std::string>& budget : {std::vector<std::string>{"--rate", "0.02"}, {}}) {
    std::vector<std::string> convert{"convert", "all.nc", "--dataset", "*", "-o", "nvdb/", "--overwrite"};
    convert.insert(convert.end(), budget.begin(), budget.end());
    const CommandResult made = weir(convert);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_NE(made.err.find(kSeries), std::string::npos) << made.err;
    EXPECT_NE(made.err.find(kVectors), std::string::npos) << made.err;
    EXPECT_EQ(made.err.find("rain"), std::string::npos) << made.err;
    EXPECT_EQ(made.err.find("files of one size"), std::string::npos) << made.err;
    EXPECT_EQ(list_directory(directory_ / "nvdb"),
              (std::vector<std::string>{"all_rho.nvdb", "all_rho.nvdb.json", "all_soil.nvdb", "all_soil.nvdb.json"}));
  }
}

TEST_F(AllDatasets, StepsOfOneSeriesHaveOneExtentWhereARateIsAsked) {
  write_inputs(R"(
with h5py.File("run.h5", "w") as f:
    for step, size in [(1, 8), (2, 8), (3, 7)]: f["step_%d/rho" % step] = np.zeros((size, 24, 30), "f4")
)");
  const CommandResult refused =
      weir({"convert", "run.h5", "--dataset", "/step_%d/rho", "--rate", "0.02", "-o", "steps/"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(refused.err,
            "weir: run.h5: /step_3/rho: extent 30x24x7 differs from 30x24x8 of run.h5: /step_1/rho, so that a rate "
            "gives files of two sizes; give --size\n");
  EXPECT_EQ(list_directory(directory_.path()), (std::vector<std::string>{"all.nc", "run.h5"}));
  EXPECT_EQ(weir({"convert", "run.h5", "--dataset", "/step_*", "--rate", "0.02", "-o", "each/"}).exit_code, 0);
}

TEST_F(AllDatasets, IndexAndComponentChooseOthers) {
  const CommandResult times = weir({"convert", "all.nc", "--dataset", "*", "--index", "time=1", "-o", "times/"});
  ASSERT_EQ(times.exit_code, 0) << times.err;
  EXPECT_NE(times.err.find("all.nc: left out: /rho: it has no leading axis; leave --index out\n"), std::string::npos)
      << times.err;
  EXPECT_NE(times.err.find(kVectors), std::string::npos) << times.err;
  EXPECT_EQ(list_directory(directory_ / "times"), (std::vector<std::string>{"all_qc_1.nvdb", "all_qc_1.nvdb.json"}));

  const CommandResult speeds =
      weir({"convert", "all.nc", "--dataset", "*", "--component", "magnitude", "-o", "speeds/"});
  ASSERT_EQ(speeds.exit_code, 0) << speeds.err;
  EXPECT_NE(speeds.err.find("all.nc: left out: /soil: its voxels have no components; leave --component out\n"),
            std::string::npos)
      << speeds.err;
  EXPECT_EQ(sidecar("speeds/all_vel_magnitude.nvdb")["source"]["dataset"], "/vel");
}

TEST_F(AllDatasets, WhereNoneIsAVolumeTheErrorSaysWhatEachNeeds) {
  const CommandResult refused = weir({"convert", "all.nc", "--dataset", "[qv]*", "-o", "nvdb/"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err,
            "weir: all.nc: --dataset [qv]* stands for no volume with these options: /qc: it has the leading axis time "
            "of 2; give --index with 1 position; /vel: each of its voxels has 3 components; give --component\n");
  EXPECT_EQ(list_directory(directory_.path()), std::vector<std::string>{"all.nc"});
}

}  // namespace
}  // namespace weir::all_datasets_test
