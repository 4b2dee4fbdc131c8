// Tests a reanalysis with latitudes from north to south, as in ERA5. Positions, regions and errors must belong to the
// rows that the file has there.
#include "tests/users/user_script.h"

namespace weir::falling_latitudes_test {
namespace {

class FallingLatitudes : public UserScript {
 protected:
  void SetUp() override {
    if (!can_write()) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
    write_inputs(R"(
n = netCDF4.Dataset("era5.nc", "w")
for name, size in [("level", 5), ("latitude", 31), ("longitude", 40)]: n.createDimension(name, size)
def coordinate(name, values, units):
    c = n.createVariable(name, "f4", (name,)); c[:] = values; c.units = units
coordinate("level", [1000, 850, 500, 250, 100], "millibars")
coordinate("latitude", np.linspace(60, 30, 31), "degrees_north")
coordinate("longitude", np.linspace(-10, 29, 40), "degrees_east")
z, y, x = np.mgrid[0:5, 0:31, 0:40]
t = (1000 * z + 60 - y + x / 100).astype("f4")      # 1000 level index + latitude + ...
v = n.createVariable("t", "f4", ("level", "latitude", "longitude"), zlib=True, chunksizes=(2, 7, 11)); v[:] = t; v.units = "K"
n.close()
t[:, ::-1].tofile("rising_40x31x5_float32.raw")
)");
  }
};

constexpr const char* kSaid =
    "era5.nc: /t: axis y (latitude) falls from 60 to 30: rows are read in reverse order, so that positions rise\n";

TEST_F(FallingLatitudes, RowsAreReadInReverseOrder) {
  const CommandResult made = weir({"convert", "era5.nc", "--lossless", "-o", "t.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.err.find(kSaid), std::string::npos) << made.err;
  EXPECT_EQ(weir({"compare", "rising_40x31x5_float32.raw", "t.nvdb"}).out,
            "lossless: all 6200 finite voxels read bit for bit\n");
  EXPECT_EQ(weir({"compare", "era5.nc", "t.nvdb"}).out, "lossless: all 6200 finite voxels read bit for bit\n");
  const nlohmann::json record = sidecar("t.nvdb");
  EXPECT_EQ(record["grid"]["origin"], (nlohmann::json{-10, 30, 0}));
  EXPECT_EQ(record["grid"]["voxel_size"], (nlohmann::json{1, 1, 1}));
  EXPECT_EQ(record["source"]["reversed_axes"], nlohmann::json{"y"});
  EXPECT_EQ(record["source"]["irregular_axes"], (nlohmann::json{{"z", {1000, 850, 500, 250, 100}}}));
}

TEST_F(FallingLatitudes, WithASpacing_IrregularPositionsAreNotKept) {
  const CommandResult made = weir({"convert", "era5.nc", "--lossless", "--spacing", "1,1,2", "-o", "t.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(sidecar("t.nvdb")["grid"]["voxel_size"], (nlohmann::json{1, 1, 2}));
  EXPECT_FALSE(sidecar("t.nvdb")["source"].contains("irregular_axes"));
}

TEST_F(FallingLatitudes, RegionsCountFromTheLowestPosition) {
  const CommandResult made = weir({"convert", "era5.nc", "--lossless", "--roi", ":,0:3,:", "-o", "south.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(weir({"compare", "rising_40x31x5_float32.raw", "south.nvdb", "--roi", ":,0:3,:"}).out,
            "lossless: all 600 finite voxels read bit for bit\n");
  EXPECT_EQ(sidecar("south.nvdb")["value_range"], (nlohmann::json{30, static_cast<float>(4032.39)}));
}

TEST_F(FallingLatitudes, InspectSaysIt) {
  const CommandResult inspected = weir({"inspect", "era5.nc"});
  EXPECT_NE(inspected.out.find("\n  axis y: falls from 60 to 30: rows are read in reverse order, so that positions "
                               "rise\n"),
            std::string::npos)
      << inspected.out;
}

TEST_F(FallingLatitudes, SpacingOnTheCommandLineLeavesTheOrderAsItIsSaid) {
  const CommandResult made =
      weir({"convert", "era5.nc", "--lossless", "--spacing", "2,2,3", "--origin", "0,0,0", "-o", "t.nvdb"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.err.find(kSaid), std::string::npos) << made.err;
  EXPECT_EQ(weir({"compare", "rising_40x31x5_float32.raw", "t.nvdb"}).out,
            "lossless: all 6200 finite voxels read bit for bit\n");
}

}  // namespace
}  // namespace weir::falling_latitudes_test
