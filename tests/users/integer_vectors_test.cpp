// Tests vectors of small integers, for example an RGB photograph or a displacement field. The lengths of the vectors
// are no integers of the components' type.
#include "tests/users/user_script.h"

namespace weir::integer_vectors_test {
namespace {

class IntegerVectors : public UserScript, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
    // Most vectors are (3, 4, 12) and have length 13. The longest vectors are longer than the type's largest number.
    write_inputs("kind = \"" + std::string(GetParam()) + "\"" + R"(
info = np.iinfo(kind)
rng = np.random.default_rng(5)
shape = (24, 28, 36)
v = rng.integers(max(info.min, -300), min(info.max, 300), shape + (3,), endpoint=True).astype(kind)
v[rng.random(shape) < 0.6] = (3, 4, 12)
v[0, 0, 0] = info.max
v[1, 1, 1] = info.min
d = v.astype("f8")
speed = np.sqrt(d[..., 0] * d[..., 0] + d[..., 1] * d[..., 1] + d[..., 2] * d[..., 2]).astype("f4")
speed.tofile("speed_36x28x24_float32.raw")
with h5py.File("a.h5", "w") as f: f.create_dataset("v", data=v, chunks=(8, 28, 36, 3), compression="gzip")
names = {"u1": "unsigned_char", "i1": "char", "u2": "unsigned_short", "i2": "short"}
with open("a.vtk", "wb") as f:
    f.write(b"# vtk DataFile Version 3.0\nv\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 36 28 24\n")
    f.write(b"ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA %d\nVECTORS v %s\n" % (36 * 28 * 24, names[kind].encode()))
    f.write(v.astype(v.dtype.newbyteorder(">")).tobytes())
)");
  }
};

TEST_P(IntegerVectors, LengthsAreKeptBitForBitAndTheirMostFrequentOneIsTheBackground) {
  for (const char* input : {"a.h5", "a.vtk"}) {
    for (const char* encoding : {"float", "auto", "packed"}) {
      SCOPED_TRACE(std::string(input) + ", " + encoding);
      const CommandResult made = weir({"convert", input, "--component", "magnitude", "--lossless", "--encoding",
                                       encoding, "-o", "speed.nvdb", "--overwrite"});
      ASSERT_EQ(made.exit_code, 0) << made.err;
      EXPECT_EQ(weir({"compare", "speed_36x28x24_float32.raw", "speed.nvdb"}).out,
                "lossless: all 24192 finite voxels read bit for bit\n");
      const nlohmann::json record = sidecar("speed.nvdb");
      EXPECT_EQ(record["background"]["value"], 13);
      EXPECT_GT(record["background"]["share"], 0.5);
      std::uint64_t counted = 0;
      for (const std::uint64_t count : record["histogram"]["counts"]) counted += count;
      EXPECT_EQ(counted, 24192U);
    }
  }
}

TEST_P(IntegerVectors, ErrorsOfALossyFileAreOfTheLengths) {
  for (const char* encoding : {"auto", "packed"}) {
    const CommandResult made = weir({"convert", "a.h5", "--component", "magnitude", "--psnr", "50", "--encoding",
                                     encoding, "-o", "speed.nvdb", "--overwrite"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto found =
        nlohmann::json::parse(weir({"compare", "speed_36x28x24_float32.raw", "speed.nvdb", "--json"}).out);
    const double certified = sidecar("speed.nvdb")["error"]["mse"];
    EXPECT_NEAR(found["mse"], certified, 1e-9 * certified) << encoding;
    EXPECT_GE(found["psnr_db"], 50) << encoding;
  }
}

TEST_P(IntegerVectors, OneComponentStaysOfItsType) {
  const CommandResult made =
      weir({"convert", "a.h5", "--component", "y", "--lossless", "--encoding", "packed", "-o", "y.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(sidecar("y.nvdb")["background"]["value"], 4);
  EXPECT_EQ(weir({"compare", "a.h5", "y.nvdb", "--component", "y"}).out,
            "lossless: all 24192 finite voxels read bit for bit\n");
}

INSTANTIATE_TEST_SUITE_P(Types, IntegerVectors, testing::Values("u1", "i1", "u2", "i2"),
                         [](const auto& type) { return std::string(type.param); });

}  // namespace
}  // namespace weir::integer_vectors_test
