// Tests statements of a file about its axes and values that a reader could miss. weir follows them or reports them.
#include "tests/users/user_script.h"

namespace weir::silent_readings_test {
namespace {

class SilentReadings : public UserScript {
 protected:
  void SetUp() override {
    if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
  }
};

TEST_F(SilentReadings, AxesInAnotherOrderThanZYX_AreNamed) {
  write_inputs(R"(
n = netCDF4.Dataset("a.nc", "w")
for name, size, step in [("x", 32, 1.0), ("y", 24, 2.0), ("z", 10, 3.0)]:
    n.createDimension(name, size)
    n.createVariable(name, "f8", (name,))[:] = step * np.arange(size)
n.createVariable("a", "f4", ("x", "y", "z"))[:] = np.random.rand(32, 24, 10)
n.createVariable("b", "f4", ("z", "y", "x"))[:] = np.random.rand(10, 24, 32)
n.close()
)");
  const std::string order =
      "its axes are x, y, z, slowest first, and x is the fastest: the file's z lies along x, x lies along z\n";
  const CommandResult made = weir({"convert", "a.nc", "--dataset", "a"});
  EXPECT_EQ(made.exit_code, 0);
  EXPECT_NE(made.err.find("warning a.nc: /a: " + order), std::string::npos) << made.err;
  EXPECT_EQ(sidecar("a_a.nvdb")["grid"]["voxel_size"], nlohmann::json({3.0, 2.0, 1.0}));
  const std::string shown = weir({"inspect", "a.nc"}).out;
  EXPECT_NE(shown.find("\n  order: " + order), std::string::npos) << shown;
  EXPECT_EQ(shown.find("order:", shown.find("order:") + 1), std::string::npos) << shown;
  EXPECT_EQ(weir({"convert", "a.nc", "--dataset", "b"}).err.find("slowest first"), std::string::npos);
}

TEST_F(SilentReadings, AttributeUnsigned_MakesSignedIntegersUnsigned) {
  write_inputs(R"(
n = netCDF4.Dataset("u.nc", "w")
for name, size in [("z", 6), ("y", 7), ("x", 8)]: n.createDimension(name, size)
for kind in ["i1", "i2"]:
    v = n.createVariable(kind, kind, ("z", "y", "x"), fill_value=-1)
    v.set_auto_maskandscale(False)
    v._Unsigned = "true"
    values = (np.arange(336) * 191 % 65535 if kind == "i2" else np.arange(336) % 255).reshape(6, 7, 8).astype("u" + kind[1])
    v[:] = values.view(kind)
    values.tofile("%s_8x7x6_uint%d.raw" % (kind, 8 * values.itemsize))
n.close()
)");
  EXPECT_NE(weir({"inspect", "u.nc"}).out.find("uint8 (stored as int8, _Unsigned)"), std::string::npos)
      << weir({"inspect", "u.nc"}).out;
  for (const std::string& raw : {std::string("i1_8x7x6_uint8.raw"), std::string("i2_8x7x6_uint16.raw")}) {
    SCOPED_TRACE(raw);
    const std::string dataset = raw.substr(0, 2);
    const CommandResult made = weir({"convert", "u.nc", "--dataset", dataset, "--lossless", "-o", dataset + ".nvdb"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(weir({"compare", raw, dataset + ".nvdb"}).out, "lossless: all 336 finite voxels read bit for bit\n");
  }
}

TEST_F(SilentReadings, AValidRangeThatIsNotApplied_IsSaid) {
  write_inputs(R"(
n = netCDF4.Dataset("v.nc", "w")
for name, size in [("z", 6), ("y", 7), ("x", 8)]: n.createDimension(name, size)
v = n.createVariable("v", "f4", ("z", "y", "x"))
v.valid_min = np.float32(0.5)
v[:] = np.random.rand(6, 7, 8)
n.close()
)");
  const CommandResult made = weir({"convert", "v.nc", "--lossless"});
  EXPECT_NE(
      made.err.find("warning v.nc: /v: its attribute valid_min is not applied: values outside it count as data\n"),
      std::string::npos)
      << made.err;
}

TEST_F(SilentReadings, BytesOfADataFileThatAHeaderLeavesOut_AreSaid) {
  write_inputs(R"(
np.arange(600, dtype="f4").tofile("a.raw")
open("a.mhd", "w").write("ObjectType = Image\nNDims = 3\nDimSize = 8 8 8\nElementType = MET_FLOAT\nElementDataFile = a.raw\n")
open("a.nhdr", "w").write("NRRD0004\ntype: float\ndimension: 3\nsizes: 8 8 8\nencoding: raw\nendian: little\ndata file: a.raw\n")
)");
  for (const auto& [header, key] : {std::pair("a.mhd", "HeaderSize"), std::pair("a.nhdr", "byte skip")}) {
    const CommandResult made = weir({"convert", header, "--lossless", "--overwrite"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_NE(
        made.err.find(std::string("warning ") + header +
                      ": its data file a.raw has 2400 bytes, and 2048 of them, from byte 0 on, are what the header "
                      "describes; where the values begin elsewhere, correct " +
                      key + "\n"),
        std::string::npos)
        << made.err;
  }
}

TEST_F(SilentReadings, ValuesRoundedToFloat_AreCountedBesideLossless) {
  write_inputs(R"(np.random.default_rng(7).random((8, 8, 8)).tofile("d_8x8x8_float64.raw"))");
  const std::string rounded = "512 values rounded to float32, by up to ";
  const CommandResult made = weir({"convert", "d_8x8x8_float64.raw", "--lossless"});
  EXPECT_NE(made.err.find("lossless, " + rounded), std::string::npos) << made.err;
  EXPECT_NE(weir({"inspect", "d_8x8x8_float64.nvdb"}).out.find(rounded), std::string::npos);
}

}  // namespace
}  // namespace weir::silent_readings_test
