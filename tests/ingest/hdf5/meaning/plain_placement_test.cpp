// Tests spacings and origins that plain attributes give.
#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::plain_placement_test {
namespace {

using Triple = std::array<double, 3>;

class PlainPlacement : public ::testing::Test {
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

TEST_F(PlainPlacement, PlainAttributesOfTheDatasetOrAGroupAroundIt) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f.attrs["spacing"] = [9.0, 9.0, 9.0]
    f["root"] = values("f4")
    g = f.create_group("VTKHDF/PointData"); g.parent.attrs.update({"Spacing": [1.0, 2.0, 3.0], "Origin": [-1.0, -2.0, -3.0]})
    g["v"] = values("f4")
    f.create_dataset("ilastik", data=values("u1")).attrs["element_size_um"] = [3.0, 2.0, 1.0]
    f.create_dataset("cremi", data=values("u1")).attrs.update({"resolution": [40.0, 4.0, 4.0], "offset": [3, 2, 1]})
    f.create_dataset("cube", data=values("u1")).attrs["voxel_size"] = 0.25
    f.create_dataset("negative", data=values("u1")).attrs["spacing"] = [1.0, -1.0, 1.0]
)");
  EXPECT_EQ(info_of("a.h5", "root").spacing, (Triple{9, 9, 9}));
  EXPECT_EQ(info_of("a.h5", "VTKHDF/PointData/v").spacing, (Triple{1, 2, 3}));
  EXPECT_EQ(info_of("a.h5", "VTKHDF/PointData/v").origin, (Triple{-1, -2, -3}));
  EXPECT_EQ(info_of("a.h5", "ilastik").spacing, (Triple{1, 2, 3}));
  EXPECT_EQ(info_of("a.h5", "cremi").spacing, (Triple{4, 4, 40}));
  EXPECT_EQ(info_of("a.h5", "cremi").origin, (Triple{1, 2, 3}));
  EXPECT_EQ(info_of("a.h5", "cube").spacing, (Triple{0.25, 0.25, 0.25}));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { info_of("a.h5", "negative"); }),
            scratch_.path("a.h5") +
                ": /negative: its spacing has -1 (attribute spacing), which is not finite and above "
                "0; give --spacing x,y,z");
}

// Simulations store their number of cells in an attribute `resolution` of the file or of the dataset.
TEST_F(PlainPlacement, ResolutionIsASpacingOfTheDatasetAloneAndNeverItsExtents) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f.attrs["resolution"] = [9.0, 9.0, 9.0]
    f["in_group"] = values("u1")
    f.create_dataset("cells", data=values("u1")).attrs["resolution"] = [5, 7, 9]
    f.create_dataset("cells_by_x", data=values("u1")).attrs["resolution"] = [9, 7, 5]
    f.create_dataset("cremi", data=values("u1")).attrs["resolution"] = [40.0, 4.0, 4.0]
    g = f.create_group("g"); g.attrs["voxel_size"] = 0.25
    g["cube"] = values("u1")
    f.create_dataset("plain", data=values("u1")).attrs["spacing"] = [1.0, 2.0, 3.0]
)");
  for (const char* name : {"in_group", "cells", "cells_by_x"}) {
    EXPECT_EQ(info_of("a.h5", name).spacing, (Triple{1, 1, 1})) << name;
    EXPECT_EQ(info_of("a.h5", name).details.values_note, "") << name;
  }
  EXPECT_EQ(info_of("a.h5", "cremi").spacing, (Triple{4, 4, 40}));
  const std::string said = "its spacing is that of the attribute resolution; --spacing sets another";
  EXPECT_EQ(info_of("a.h5", "cremi").details.values_note, said);
  EXPECT_EQ(attribute("a.h5", "/cremi", "note"), said);
  EXPECT_EQ(info_of("a.h5", "g/cube").details.values_note,
            "its spacing is that of the attribute voxel_size of a group around it; --spacing sets another");
  EXPECT_EQ(info_of("a.h5", "plain").details.values_note, "");
  SourceOptions options = dataset_options("cremi");
  options.spacing = {1.0, 1.0, 1.0};
  EXPECT_EQ(open_source(scratch_.path("a.h5"), options)->info().details.values_note, "");
}

TEST_F(PlainPlacement, PlainAttributesFillNoAxisOfIrregularCoordinates) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    v = f.create_dataset("v", data=values("f4", (2, 3, 4)))
    f["z"] = [0.0, 1.0]
    f["y"] = [0.0, 1.0, 5.0]
    for axis, name in enumerate(["z", "y"]):
        f[name].make_scale(name)
        v.dims[axis].attach_scale(f[name])
    v.attrs.update({"voxel_size": [2.0, 3.0, 4.0], "origin": [7.0, 8.0, 9.0]})
)");
  const SourceInfo info = info_of("a.h5", "v");
  EXPECT_EQ(info.spacing, (Triple{2, 1, 1}));
  EXPECT_EQ(info.origin, (Triple{7, 0, 0}));
  EXPECT_EQ(info.details.axes[1].note, "irregular coordinates from 0 to 5, taken as indices");
}

}  // namespace
}  // namespace weir::plain_placement_test
