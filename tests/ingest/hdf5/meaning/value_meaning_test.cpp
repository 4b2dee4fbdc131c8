// What attributes say of the values of HDF5 files, and weir makes nothing of.
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

}  // namespace
}  // namespace weir::value_meaning_test
