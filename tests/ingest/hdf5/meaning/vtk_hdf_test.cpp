// Tests the times and marks in VTK's own HDF5 files. hdf5_placement_test.cpp tests where their voxels lie.
#include "ingest/hdf5/meaning/vtk_hdf.h"

#include "ingest/hdf5/hdf5_source.h"
#include "ingest/series.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::vtk_hdf_test {
namespace {

class VtkHdf : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }
  /// Writes a.vtkhdf with the group `g`, an image of 9 x 7 x 5 points, and whatever `script` adds.
  void write(const std::string& script) const {
    write_by_h5py(scratch_, R"(
f = h5py.File("a.vtkhdf", "w")
g = f.create_group("VTKHDF")
g.attrs.update({"WholeExtent": [0, 8, 0, 6, 0, 4], "Origin": [0.0, 0, 0], "Spacing": [1.0, 2, 3]})
def steps(times, **offsets):
    s = g.require_group("Steps"); s["Values"] = np.asarray(times); s.attrs["NSteps"] = len(times)
    for name, at in offsets.items(): s["PointDataOffsets/" + name] = np.asarray(at)
)" + script + "\nf.close()\n");
  }
  SourceInfo info(const std::string& dataset, std::vector<std::int64_t> index = {}) const {
    return open_source(scratch_.path("a.vtkhdf"), dataset_options(dataset, std::move(index)))->info();
  }
  std::optional<double> time(const std::string& dataset, std::vector<std::int64_t> index = {}) const {
    const auto found = info(dataset, std::move(index)).details.time;
    if (!found) return std::nullopt;
    EXPECT_EQ(found->units, "") << "VTK says none";
    return found->value;
  }

  Scratch scratch_;
};

// "VTKHDF File Format", temporal data: an array of an image stores the steps along its slowest axis.
TEST_F(VtkHdf, ValuesOfItsSteps_AreTheTimes) {
  write(R"(
v = values("f4", (3,) + SHAPE)
g["PointData/v"] = v; expect("v1", v[1])
g["PointData/w"] = values("f4", (3,) + SHAPE + (3,))
steps([0.5, 0.75, 2.0])
)");
  for (std::int64_t i = 0; i < 3; ++i) {
    EXPECT_EQ(time("VTKHDF/PointData/v", {i}), (std::array{0.5, 0.75, 2.0}).at(static_cast<std::size_t>(i)));
  }
  EXPECT_EQ(info("VTKHDF/PointData/v", {1}).spacing, (std::array<double, 3>{1, 2, 3}));
  SourceOptions named = dataset_options("VTKHDF/PointData/v");
  named.index_choices = {{"time", false, 1, {}}};
  expect_reads(scratch_, "a.vtkhdf", named, "v1");
  SourceOptions component = dataset_options("VTKHDF/PointData/w", {2});
  component.component = ComponentChoice{false, 1};
  EXPECT_EQ(open_source(scratch_.path("a.vtkhdf"), component)->info().details.time->value, 2.0);
}

// By offsets, several steps share one element of an array that did not change.
TEST_F(VtkHdf, OffsetsOfAnArray_SayWhichElementAStepHas) {
  write(R"(
g["PointData/shared"] = values("f4", (2,) + SHAPE)
g["PointData/lost"] = values("f4", (3,) + SHAPE)
g["PointData/more"] = values("f4", (4,) + SHAPE)
steps([1.0, 2.0, 3.0], shared=[1, 1, 0], lost=[0, 2, 2])
)");
  EXPECT_EQ(time("VTKHDF/PointData/shared", {0}), 3.0);
  EXPECT_EQ(time("VTKHDF/PointData/shared", {1}), 1.0) << "the first step that has it";
  EXPECT_EQ(time("VTKHDF/PointData/lost", {0}), std::nullopt) << "no step has element 1";
  EXPECT_EQ(time("VTKHDF/PointData/more", {0}), std::nullopt);
}

TEST_F(VtkHdf, OneTime_IsThatOfTheImage) {
  write(R"(
g["PointData/v"] = values("f4")
g["FieldData/TimeValue"] = np.array([1.25])
)");
  EXPECT_EQ(time("VTKHDF/PointData/v"), 1.25);
  write(R"(
g["PointData/v"] = values("f4")
g["PointData/series"] = values("f4", (1,) + SHAPE)
steps([7.5])
)");
  EXPECT_EQ(time("VTKHDF/PointData/v"), 7.5);
  EXPECT_EQ(time("VTKHDF/PointData/series"), 7.5);
}

TEST_F(VtkHdf, TimesThatAreNone_AreLeftOut) {
  write(R"(
g["PointData/v"] = values("f4")
g["FieldData/TimeValue"] = np.array([np.nan])
)");
  EXPECT_EQ(time("VTKHDF/PointData/v"), std::nullopt);
  write(R"(
g["PointData/v"] = values("f4")
g["FieldData/TimeValue"] = np.array([1.0, 2.0])
)");
  EXPECT_EQ(time("VTKHDF/PointData/v"), std::nullopt);
  write(R"(
g["PointData/v"] = values("f4")
g.create_group("FieldData/TimeValue")
)");
  EXPECT_EQ(time("VTKHDF/PointData/v"), std::nullopt);
}

TEST_F(VtkHdf, GhostTypes_AreReadByNameOnly) {
  write(R"(
g["PointData/v"] = values("f4")
g["PointData/vtkGhostType"] = np.ones(SHAPE, "u1")
f["vtkGhostType"] = np.ones(SHAPE, "u1")
)");
  const std::string path = scratch_.path("a.vtkhdf");
  const auto names = [&](const std::string& dataset) {
    std::string text;
    for (const SeriesStep& step : expand_series(std::vector{path}, dataset_options(dataset)))
      text += step.dataset + ' ';
    return text;
  };
  EXPECT_EQ(names("VTKHDF*"), "/VTKHDF/PointData/v ");
  EXPECT_EQ(names("*"), "/vtkGhostType /VTKHDF/PointData/v ") << "what lies in no image is a field";
  EXPECT_EQ(names("/VTKHDF/PointData/vtkGhostType"), "/VTKHDF/PointData/vtkGhostType ");
  EXPECT_EQ(info("VTKHDF/PointData/vtkGhostType").type, ScalarType::uint8);
  write(R"(
g["PointData/v"] = values("f4")
g["PointData/vtkGhostType"] = np.ones(SHAPE, "u1")
)");
  EXPECT_EQ(open_source(path, {})->info().dataset, "/VTKHDF/PointData/v");
}

}  // namespace
}  // namespace weir::vtk_hdf_test
