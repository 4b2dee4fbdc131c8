// Tests NetCDF files, which name every axis: vectors along a last axis with the name nv, dim or three, and time axes
// that are not the first axis.
#include "tests/users/user_script.h"

namespace weir::named_dimensions_test {
namespace {

class NamedDimensions : public UserScript {
 protected:
  void SetUp() override {
    if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
  }
};

TEST_F(NamedDimensions, LastAxisOfVectorsIsKnownWhateverItIsCalled) {
  write_inputs(R"(
z, y, x = np.mgrid[0:10, 0:12, 0:14]
v = np.stack([np.sin(x / 9), np.cos(y / 7), z / 40.0], axis=-1).astype("f4")
for name in ["nv", "dim", "d", "three", "space", "axis", "i", "dir", "coord"]:
    n = netCDF4.Dataset(name + ".nc", "w")
    for dimension, size in [("z", 10), ("y", 12), ("x", 14), (name, 3)]: n.createDimension(dimension, size)
    n.createVariable("vel", "f4", ("z", "y", "x", name))[:] = v
    n.close()
v[..., 1].tofile("y_14x12x10_float32.raw")
)");
  for (const std::string name : {"nv", "dim", "d", "three", "space", "axis", "i", "dir", "coord"}) {
    SCOPED_TRACE(name);
    const std::string file = name + ".nc";
    const std::string shown = weir({"inspect", file}).out;
    EXPECT_NE(shown.find("\n  components: 3 along the last axis, by its extent, after the axis x\n"), std::string::npos)
        << shown;
    EXPECT_NE(shown.find("\n  weir convert " + file + " --dataset /vel --component magnitude\n"), std::string::npos)
        << shown;
    EXPECT_EQ(weir({"convert", file}).err,
              "weir: " + file + ": /vel: its axes are z=10 x y=12 x x=14 x " + name +
                  "=3, the last of them of components (by its extent, after the axis x); give --component: 0 to 2, x, "
                  "y, z or magnitude; or --index with 1 position for volumes of 3 voxels along x\n");
    ASSERT_EQ(weir({"convert", file, "--component", "y", "--lossless", "-o", "y.nvdb", "--overwrite"}).exit_code, 0);
    EXPECT_EQ(weir({"compare", "y_14x12x10_float32.raw", "y.nvdb"}).out,
              "lossless: all 1680 finite voxels read bit for bit\n");
  }
}

TEST_F(NamedDimensions, TimeIsChosenWhereverItLies) {
  write_inputs(R"(
n = netCDF4.Dataset("t.nc", "w")
for name, size in [("time", 4), ("z", 10), ("y", 12), ("x", 14)]: n.createDimension(name, size)
t = n.createVariable("time", "f8", ("time",)); t[:] = [0, 6, 12, 18]; t.units = "hours since 2000-01-01"
v = np.arange(4 * 10 * 12 * 14, dtype="f4").reshape(4, 10, 12, 14)
n.createVariable("second", "f4", ("z", "time", "y", "x"))[:] = np.moveaxis(v, 0, 1)
n.createVariable("third", "f4", ("z", "y", "time", "x"), zlib=True, chunksizes=(3, 5, 2, 7))[:] = np.moveaxis(v, 0, 2)
n.createVariable("last", "f4", ("z", "y", "x", "time"), zlib=True)[:] = np.moveaxis(v, 0, 3)
n.close()
v[2].tofile("at2_14x12x10_float32.raw")
)");
  const std::string inspected = weir({"inspect", "t.nc"}).out;
  for (const std::string name : {"second", "third", "last"}) {
    SCOPED_TRACE(name);
    EXPECT_NE(inspected.find("\n  weir convert t.nc --dataset /" + name + " --index time=0\n"), std::string::npos)
        << inspected;
    const CommandResult made =
        weir({"convert", "t.nc", "--dataset", name, "--index", "time=2", "--lossless", "-o", name + ".nvdb"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_NE(made.err.find(name + ".nvdb: /" + name + " at 2, 14x12x10 voxels, "), std::string::npos) << made.err;
    EXPECT_EQ(weir({"compare", "at2_14x12x10_float32.raw", name + ".nvdb"}).out,
              "lossless: all 1680 finite voxels read bit for bit\n");
    EXPECT_EQ(weir({"compare", "t.nc", name + ".nvdb"}).out, "lossless: all 1680 finite voxels read bit for bit\n");
    EXPECT_EQ(sidecar(name + ".nvdb")["source"]["time"]["value"], 12);
  }
  EXPECT_EQ(
      weir({"convert", "t.nc", "--dataset", "second"}).err,
      "weir: t.nc: /second: its axes are z=10 x time=4 x y=12 x x=14, and a volume has three; give --index with 1 "
      "position: time in 0..3\n");
}

}  // namespace
}  // namespace weir::named_dimensions_test
