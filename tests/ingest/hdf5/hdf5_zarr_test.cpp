// Checks that a dataset that xarray writes as NetCDF and as Zarr gives the same volume from both.
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_zarr_test {
namespace {

TEST(Hdf5AndZarr, OfOneDatasetOfXarray_AreOneVolume) {
  if (!python_has("xarray, zarr, netCDF4")) GTEST_SKIP() << "python3 with xarray, zarr and netCDF4 is missing";
  const Scratch scratch;
  write_by_h5py(scratch, R"(
import pandas as pd, xarray as xr
def dataset(levels, lats):
    return xr.Dataset(
        {"T": (("time", "level", "lat", "lon"), values("f4", (2, len(levels), len(lats), 6)), {"units": "K"})},
        {"time": pd.date_range("2001-01-01", periods=2, freq="6H"),
         "level": ("level", np.asarray(levels, "f4"), {"units": "hPa"}),
         "lat": ("lat", lats, {"units": "degrees_north"}),
         "lon": ("lon", np.arange(6) * 0.25, {"units": "degrees_east"})})
for name, levels, lats in [("falling", [1000, 850, 700], np.arange(5)[::-1] * 0.5),
                           ("rising", [10, 20, 30, 40], np.arange(7) - 3.0),
                           ("irregular", [1000, 925, 850, 700], np.arange(4) * 1.0),
                           ("zero", [0], np.zeros(1))]:
    d = dataset(levels, lats)
    d.to_netcdf(name + ".nc")
    d.to_zarr(name + ".zarr")
)");
  for (const std::string name : {"falling", "rising", "irregular", "zero"}) {
    const auto netcdf = open_source(scratch.path(name + ".nc"), dataset_options("T", {1}));
    const auto zarr = open_source(scratch.path(name + ".zarr"), dataset_options("T", {1}));
    const SourceInfo& expected = netcdf->info();
    const SourceInfo& found = zarr->info();
    EXPECT_EQ(found.spacing, expected.spacing) << name;
    EXPECT_EQ(found.origin, expected.origin) << name;
    EXPECT_EQ(found.units, expected.units) << name;
    EXPECT_EQ(found.details.units_note, expected.details.units_note) << name;
    ASSERT_TRUE(found.details.time && expected.details.time) << name;
    EXPECT_EQ(found.details.time->value, expected.details.time->value) << name;
    EXPECT_EQ(found.details.time->units, expected.details.time->units) << name;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(found.details.axes.at(axis).note, expected.details.axes.at(axis).note) << name << axis;
      EXPECT_EQ(found.details.axes.at(axis).units, expected.details.axes.at(axis).units) << name << axis;
      EXPECT_EQ(found.details.axes.at(axis).coordinates, expected.details.axes.at(axis).coordinates) << name << axis;
      EXPECT_EQ(found.details.axes.at(axis).reversed, expected.details.axes.at(axis).reversed) << name << axis;
    }
    EXPECT_EQ(all_values(*zarr), all_values(*netcdf)) << name;
  }
}

}  // namespace
}  // namespace weir::hdf5_zarr_test
