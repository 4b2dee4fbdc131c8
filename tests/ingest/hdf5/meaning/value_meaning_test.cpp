// Tests attributes of HDF5 files that weir does not apply to the values, and the default fill values of NetCDF.
#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::value_meaning_test {
namespace {

class Hdf5ValueMeaning : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }
  SourceInfo info_of(const std::string& file, const std::string& dataset) {
    return open_source(scratch_.path(file), dataset_options(dataset))->info();
  }
  std::string attribute(const std::string& file, const std::string& dataset, const std::string& name) {
    for (const DatasetInfo& listed : list_hdf5(scratch_.path(file), {})) {
      for (const auto& [key, value] : listed.attributes) {
        if (listed.name == dataset && key == name) return value;
      }
    }
    return {};
  }

  Scratch scratch_;
};

TEST_F(Hdf5ValueMeaning, MissingValuesThatTheTypeDoesNotHaveAreSaid) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("packed", data=np.arange(8, dtype="i2").reshape(2, 2, 2))
    d.attrs.update({"missing_value": -999999.0, "scale_factor": 0.5, "valid_min": 0})
    f.create_dataset("held", data=np.arange(8, dtype="u1").reshape(2, 2, 2)).attrs["_FillValue"] = 255.0
)");
  const std::string said =
      "its attribute missing_value is -999999, and no int16 is, so it marks no voxel; --missing names the stored value "
      "that stands for no data; its attribute valid_min is not applied: values outside it count as data";
  EXPECT_EQ(info_of("a.h5", "packed").details.values_note, said);
  EXPECT_EQ(attribute("a.h5", "/packed", "note"), said);
  EXPECT_EQ(info_of("a.h5", "held").details.values_note, "");
}

// netCDF4-python masks values that were never written. The same values must be missing in weir.
TEST_F(Hdf5ValueMeaning, NetcdfsDefaultFill_IsNoDataBesideMissingValueAndInFilesOfOldLibraries) {
  if (!python_has("netCDF4")) GTEST_SKIP() << "python3 with netCDF4 is missing";
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("new.nc", "w")
for name, size in [("z", 6), ("y", 2), ("x", 2)]: n.createDimension(name, size)
for name, kind in [("float", "f4"), ("short", "i2"), ("own", "f4")]:
    v = n.createVariable(name, kind, ("z", "y", "x"), fill_value=9e9 if name == "own" else None)
    v.missing_value = np.array(-999, kind)
    v[:4] = 1
    v[0, 0, 0] = -999
    expect(name, np.ma.getmaskarray(v[:]).astype("f4"))
n.close()
import shutil
shutil.copy("new.nc", "old.nc")
with h5py.File("old.nc", "a") as f: del f.attrs["_NCProperties"]
)");
  for (const char* file : {"new.nc", "old.nc"}) {
    for (const char* name : {"float", "short", "own"}) {
      const auto source = open_source(scratch_.path(file), dataset_options(name));
      std::vector<float> masked = all_values(*source);
      for (float& value : masked) value = is_missing(value) ? 1.0F : 0.0F;
      EXPECT_EQ(masked, expected(scratch_, name)) << file << ' ' << name;
    }
  }
}

// In a file of another writer, a whole number like NetCDF's default may be a fill value that the writer chose.
TEST_F(Hdf5ValueMeaning, WholeNumberLikeNetcdfsDefaultFill_IsDataInOtherFiles) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("d", (2, 2, 2), "i2", chunks=(1, 2, 2), fillvalue=-32767)
    d[0] = 1
)");
  EXPECT_EQ(all_values(*open_source(scratch_.path("a.h5"), {})),
            (std::vector<float>{1, 1, 1, 1, -32767, -32767, -32767, -32767}));
}

}  // namespace
}  // namespace weir::value_meaning_test
