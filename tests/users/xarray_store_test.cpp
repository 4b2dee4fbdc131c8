// Tests the conversion of a Zarr store that xarray wrote. Values that xarray masks are missing, and coordinates place
// the voxels.
#include "ingest/zarr/codecs/library_codecs.h"
#include "tests/users/user_script.h"

namespace weir::xarray_store_test {
namespace {

class XarrayStore : public UserScript {
 protected:
  void SetUp() override {
    if (!python_has("xarray, zarr") || !can_write()) GTEST_SKIP() << "python3 with xarray and zarr is missing";
    // xarray compresses what it writes with Blosc.
    if (!has_library_codecs()) GTEST_SKIP() << "this build was left without libblosc and libzstd (WEIR_ZARR_CODECS)";
    write_inputs(R"(
import xarray
a = 300 + np.arange(4096.0).reshape(16, 16, 16) / 100
a[0, 0, 0] = np.nan
axes = ("z", "y", "x")
packed = {"dtype": "int16", "scale_factor": 0.01, "add_offset": 300.0, "_FillValue": -32768}
xarray.Dataset({"T": (axes, a)}).to_zarr("t.zarr", encoding={"T": packed})
xarray.Dataset({"n": (axes, np.arange(64).reshape(4, 4, 4))}).to_zarr("n.zarr")
xarray.Dataset({"T": (axes, a)}, {"z": np.arange(16.0) * 10, "x": np.arange(16.0) * 2 + 100}).to_zarr("c.zarr", encoding={"T": packed})
)");
  }
};

TEST_F(XarrayStore, MaskedVoxels_HoldNoData) {
  const CommandResult refused = weir({"convert", "t.zarr", "--lossless"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(
      refused.err,
      "weir: t.zarr, dataset T: 1 of 4096 voxels (less than 0.1 %) holds no data (stored as -32768), the first at "
      "0,0,0; choose --missing-policy background or, to take -32768 for data, --missing-policy keep\n");
  const CommandResult made = weir({"convert", "t.zarr", "--lossless", "--missing-policy", "background"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(sidecar("t.nvdb")["missing"]["count"], 1);
  EXPECT_GE(sidecar("t.nvdb")["value_range"][0].get<double>(), 300);
}

TEST_F(XarrayStore, ZeroOfAnArrayWithoutFillValue_IsData) {
  const CommandResult made = weir({"convert", "n.zarr", "--lossless"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(sidecar("n.nvdb")["missing"]["count"], 0);
}

TEST_F(XarrayStore, Coordinates_PlaceTheVoxels) {
  const CommandResult made =
      weir({"convert", "c.zarr", "--dataset", "T", "--lossless", "--missing-policy", "background", "--overwrite"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(sidecar("c.nvdb")["grid"]["voxel_size"], (nlohmann::json{2, 1, 10}));
  EXPECT_EQ(sidecar("c.nvdb")["grid"]["origin"], (nlohmann::json{100, 0, 0}));
}

}  // namespace
}  // namespace weir::xarray_store_test
