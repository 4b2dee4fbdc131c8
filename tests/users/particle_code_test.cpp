// Tests a step of a particle-in-cell code in the openPMD layout: values at cell centres and on faces, vectors of three
// datasets, a time, and units in SI.
#include "tests/users/user_script.h"

namespace weir::particle_code_test {
namespace {

class ParticleCode : public UserScript {
 protected:
  void SetUp() override {
    if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
    write_inputs(R"(
z, y, x = np.mgrid[0:24, 0:32, 0:40].astype("f8")
with h5py.File("fields_100.h5", "w") as f:
    f.attrs.update({"openPMD": "1.1.0", "basePath": "/data/%T/", "meshesPath": "meshes/", "iterationEncoding": "fileBased"})
    step = f.create_group("data/100")
    step.attrs.update({"time": 5e-14, "dt": 5e-16, "timeUnitSI": 1.0})
    grid = {"axisLabels": np.array(["z", "y", "x"], "S"), "dataOrder": "C", "geometry": "cartesian", "gridUnitSI": 1e-6,
            "gridSpacing": [0.2, 0.1, 0.1], "gridGlobalOffset": [3.0, -1.6, -2.0]}
    rho = step.create_dataset("meshes/rho", data=np.exp(-((x - 20)**2 + (y - 16)**2 + (z - 12)**2) / 40))
    rho.attrs.update(dict(grid, unitSI=1.6e5, position=[0.5, 0.5, 0.5]))
    e = step.create_group("meshes/E")
    e.attrs.update(grid)
    for i, axis in enumerate("xyz"):
        d = e.create_dataset(axis, data=np.sin(x / 5 + i) * np.cos(z / 4))
        position = [0.0, 0.0, 0.0]
        position[2 - i] = 0.5
        d.attrs.update({"unitSI": 1e9, "position": position})
)");
  }
};

TEST_F(ParticleCode, WithoutAChoice_EveryFieldIsNamedWithItsCommand) {
  const CommandResult refused = weir({"convert", "fields_100.h5"});
  EXPECT_EQ(refused.exit_code, 2);
  for (const char* name :
       {"/data/100/meshes/rho", "/data/100/meshes/E/x", "/data/100/meshes/E/y", "/data/100/meshes/E/z"}) {
    EXPECT_NE(refused.err.find(std::string("weir convert fields_100.h5 --dataset ") + name), std::string::npos)
        << refused.err;
  }
}

TEST_F(ParticleCode, CentreOfTheFirstVoxel_IsWhereItsValueLies) {
  ASSERT_EQ(weir({"convert", "fields_100.h5", "--dataset", "/data/100/meshes/*", "--lossless", "-o", "out/"}).exit_code,
            0);
  const auto expect_placed = [&](const std::string& volume, const std::array<double, 3>& origin) {
    const nlohmann::json grid = sidecar("out/fields_100_data.100.meshes." + volume + ".nvdb")["grid"];
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(grid["voxel_size"][i], (std::array{1e-7, 1e-7, 2e-7}.at(i)), 1e-20) << volume;
      EXPECT_NEAR(grid["origin"][i], origin.at(i), 1e-15) << volume;
    }
  };
  expect_placed("rho", {-1.95e-6, -1.55e-6, 3.1e-6});
  expect_placed("E.x", {-1.95e-6, -1.6e-6, 3e-6});
  expect_placed("E.z", {-2e-6, -1.6e-6, 3.1e-6});
}

TEST_F(ParticleCode, ATimeAndTheUnitOfTheValues_AreKept) {
  ASSERT_EQ(weir({"convert", "fields_100.h5", "--dataset", "/data/100/meshes/rho", "--psnr", "60"}).exit_code, 0);
  const nlohmann::json source = sidecar("fields_100_data.100.meshes.rho.nvdb")["source"];
  EXPECT_EQ(source["time"]["value"], 5e-14);
  EXPECT_EQ(source["time"]["units"], "s");
  EXPECT_EQ(source["unit_si"], 1.6e5);
  EXPECT_EQ(source["axes"], (nlohmann::json{"x", "y", "z"}));
}

}  // namespace
}  // namespace weir::particle_code_test
