// Tests a velocity field with its components along the last axis, as flow solvers and h5py write it.
#include <filesystem>

#include "tests/support/sanitized.h"
#include "tests/users/user_script.h"

namespace weir::vector_field_test {
namespace {

class VectorField : public UserScript {
 protected:
  void SetUp() override {
    if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
    write_inputs(R"(
z, y, x = np.mgrid[0:40, 0:48, 0:56].astype("f4")
v = np.stack([np.sin(x / 9), np.cos(y / 7), z / 40], axis=-1).astype("f4")
with h5py.File("flow.h5", "w") as f: f.create_dataset("velocity", data=v, chunks=(8, 48, 56, 3), compression="gzip")
with h5py.File("mix.h5", "w") as f:
    f["fields/rho"] = z[:16, :16, :16]
    f["fields/T"] = np.stack([x[:16, :16, :16]] * 12)
    f["u"] = v[:16, :17, :18]
    f["profile"] = np.arange(16)
d = v.astype("f8")
speed = np.sqrt(d[..., 0] * d[..., 0] + d[..., 1] * d[..., 1] + d[..., 2] * d[..., 2]).astype("f4")
speed.tofile("speed_56x48x40_float32.raw")
v[..., 2].tofile("w_56x48x40_float32.raw")
)");
  }
};

TEST_F(VectorField, WithoutAChoiceTheMessageSaysWhatThereIs) {
  const CommandResult refused = weir({"convert", "flow.h5"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err,
            "weir: flow.h5: /velocity: its axes are 40 x 48 x 56 x 3, the last of them of components (by its extent "
            "alone); give --component: 0 to 2, x, y, z or magnitude; or --index with 1 position for volumes of 3 "
            "voxels along x\n");
}

TEST_F(VectorField, CommandThatInspectPrintsConvertsTheMagnitude) {
  const CommandResult inspected = weir({"inspect", "flow.h5"});
  EXPECT_NE(inspected.out.find("  components: 3 along the last axis, by its extent alone\n"), std::string::npos);
  EXPECT_NE(inspected.out.find("\n  weir convert flow.h5 --dataset /velocity --component magnitude\n"),
            std::string::npos)
      << inspected.out;
  const CommandResult made = type("weir convert flow.h5 --dataset /velocity --component magnitude --psnr 60");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.err.find("flow_magnitude.nvdb: /velocity, magnitude, 56x48x40 voxels, "), std::string::npos)
      << made.err;
  EXPECT_EQ(sidecar("flow_magnitude.nvdb")["source"]["component"], "magnitude");
}

TEST_F(VectorField, ComponentsOfAField_AreFilesBesideEachOther) {
  for (const char* component : {"x", "1", "z", "magnitude"}) {
    EXPECT_EQ(weir({"convert", "flow.h5", "--component", component, "-o", "out/"}).exit_code, 0) << component;
  }
  EXPECT_EQ(
      list_directory(directory_ / "out"),
      (std::vector<std::string>{"flow_magnitude.nvdb", "flow_magnitude.nvdb.json", "flow_x.nvdb", "flow_x.nvdb.json",
                                "flow_y.nvdb", "flow_y.nvdb.json", "flow_z.nvdb", "flow_z.nvdb.json"}));
  const CommandResult again = weir({"convert", "flow.h5", "--component", "y", "-o", "out/"});
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_EQ(again.err, "weir: out/flow_y.nvdb: exists; choose another output or pass --overwrite\n");
}

TEST_F(VectorField, CommandsThatInspectPrintsForAllKindsOfFields_MakeAFileEach) {
  EXPECT_EQ(run_printed_commands("mix.h5"), 3);
  EXPECT_EQ(weir({"convert", "mix.h5", "--dataset", "fields/T", "--index", "3"}).exit_code, 0);
  EXPECT_EQ(weir({"convert", "mix.h5", "--dataset", "/fields/T", "--index", "-1"}).exit_code, 0);
  EXPECT_EQ(weir({"convert", "mix.h5", "--component", "z"}).exit_code, 0);
  for (const char* name : {"mix_fields.rho.nvdb", "mix_fields.T_00.nvdb", "mix_fields.T_03.nvdb",
                           "mix_fields.T_11.nvdb", "mix_u_magnitude.nvdb", "mix_u_z.nvdb"}) {
    EXPECT_TRUE(std::filesystem::exists(directory_ / name)) << name;
  }
}

TEST_F(VectorField, CertificateIsOfTheMagnitude) {
  const CommandResult made =
      weir({"convert", "flow.h5", "--component", "magnitude", "--psnr", "60", "-o", "speed.nvdb", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const CommandResult compared = weir({"compare", "speed_56x48x40_float32.raw", "speed.nvdb", "--json"});
  const double certified = nlohmann::json::parse(made.out)["error"]["mse"];
  EXPECT_NEAR(nlohmann::json::parse(compared.out)["mse"], certified, 1e-12 * certified);
  const CommandResult again = weir({"compare", "flow.h5", "speed.nvdb", "--json"});
  EXPECT_NE(
      again.err.find("flow.h5: read with --dataset /velocity --component magnitude, as speed.nvdb.json records\n"),
      std::string::npos)
      << again.err;
  EXPECT_EQ(nlohmann::json::parse(again.out)["mse"], nlohmann::json::parse(compared.out)["mse"]);
}

TEST_F(VectorField, ComponentIsThatOfTheFileBitForBit) {
  ASSERT_EQ(weir({"convert", "flow.h5", "--component", "z", "--lossless", "-o", "w.nvdb"}).exit_code, 0);
  EXPECT_EQ(weir({"compare", "w_56x48x40_float32.raw", "w.nvdb"}).out,
            "lossless: all 107520 finite voxels read bit for bit\n");
}

TEST_F(VectorField, OtherReadingIsThereForWhoAsksForIt) {
  const CommandResult made = weir({"convert", "flow.h5", "--index", "0", "-o", "thin.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.err.find("thin.nvdb: /velocity at 0, 3x56x48 voxels, "), std::string::npos) << made.err;
}

class VectorsWithoutData : public UserScript {
 protected:
  void SetUp() override {
    if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
    write_inputs(R"(
v = np.arange(16 * 24 * 28 * 3, dtype="f4").reshape(16, 24, 28, 3) % 50
v[:4] = -999
v[5, 0, 0, 1] = -999
with h5py.File("land.h5", "w") as f: f.create_dataset("v", data=v).attrs["_FillValue"] = np.float32(-999)
)");
  }
};

TEST_F(VectorsWithoutData, KeptOnes_AreCountedOnceEach) {
  const CommandResult made = weir(
      {"convert", "land.h5", "--component", "magnitude", "--missing-policy", "keep", "--lossless", "-o", "speed.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.err.find(", lossless, 2689 of 10752 voxels (25 %) hold no data and are kept as data, "),
            std::string::npos)
      << made.err;
  EXPECT_EQ(sidecar("speed.nvdb")["missing"]["count"], 4 * 24 * 28 + 1);
  EXPECT_EQ(weir({"compare", "land.h5", "speed.nvdb"}).out, "lossless: all 10752 finite voxels read bit for bit\n");
}

class VectorFieldMemory : public UserScript {};

TEST_F(VectorFieldMemory, MagnitudeOfAFieldOfManyCeilingsStaysUnderIt) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
  write_inputs(R"(
v = np.arange(3 * 256 * 256, dtype="f8").reshape(256, 256, 3) % 251
with h5py.File("large.h5", "w") as f:
    d = f.create_dataset("velocity", (200, 256, 256, 3), "f8")
    for z in range(200): d[z] = v + z
)");
  const CommandResult made =
      weir({"convert", "large.h5", "--component", "magnitude", "--memory", "64MiB", "-o", "large.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_GE(std::filesystem::file_size(directory_ / "large.h5"), 4U * (std::uint64_t{64} << 20U));
  EXPECT_LT(made.peak_rss_bytes, std::uint64_t{64} << 20U);
}

}  // namespace
}  // namespace weir::vector_field_test
