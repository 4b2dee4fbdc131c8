// Compares the values of published files of three simulations with what h5py reads, bit for bit. Files that are not on
// this machine are skipped.
#include <algorithm>

#include "format/base/text.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_real_test {
namespace {

class Hdf5Real : public ::testing::Test {
 protected:
  // Links the published `file` into the directory of scratch_. Skips the test if the file or h5py is missing.
  void take(const std::string& file) {
    const auto published = std::filesystem::path(WEIR_SOURCE_DIR) / "../shared/data" / file;
    if (!std::filesystem::exists(published)) GTEST_SKIP() << "skipped: no " << published;
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
    std::filesystem::create_symlink(std::filesystem::absolute(published), scratch_.path(file));
  }

  Scratch scratch_;
};

TEST_F(Hdf5Real, WrfCloudWaterAtEachTime) {
  take("wrf_katrina_ci_test_file.nc");
  if (IsSkipped()) return;
  write_by_h5py(scratch_, R"(
f = h5py.File("wrf_katrina_ci_test_file.nc")
for t in range(4): expect("t%d" % t, f["QCLOUD"][t])
)");
  float largest = 0;
  for (std::int64_t t = 0; t < 4; ++t) {
    expect_reads(scratch_, "wrf_katrina_ci_test_file.nc", dataset_options("QCLOUD", {t}), cat("t", t));
    const std::vector<float> values = expected(scratch_, cat("t", t));
    largest = std::max(largest, *std::max_element(values.begin(), values.end()));
  }
  EXPECT_NEAR(largest, 1.81e-3, 0.005e-3);  // the figure of the data's manifest
  const auto source = open_source(scratch_.path("wrf_katrina_ci_test_file.nc"), dataset_options("QCLOUD", {2}));
  const SourceInfo& info = source->info();
  EXPECT_EQ(info.extent, (Index3{48, 48, 14}));
  EXPECT_EQ(info.axis_labels, (std::array<std::string, 3>{"west_east", "south_north", "bottom_top"}));
  EXPECT_EQ(info.units, "kg kg-1");
  EXPECT_EQ(info.index, (std::vector<std::int64_t>{2}));
}

TEST_F(Hdf5Real, OpenPmdField) {
  take("openpmd_example-femm-3d.h5");
  if (IsSkipped()) return;
  write_by_h5py(scratch_, R"(
f = h5py.File("openpmd_example-femm-3d.h5")
expect("B", f["/data/1/meshes/B/z"][...]); expect("E", np.zeros((47, 47, 47)))
)");
  expect_reads(scratch_, "openpmd_example-femm-3d.h5", dataset_options("/data/1/meshes/B/z"), "B");
  expect_reads(scratch_, "openpmd_example-femm-3d.h5", dataset_options("/data/1/meshes/E/x"), "E");
  const auto source = open_source(scratch_.path("openpmd_example-femm-3d.h5"), dataset_options("/data/1/meshes/B/z"));
  const SourceInfo& info = source->info();
  // The labels are in C order: the last, fastest axis is the mesh's z.
  EXPECT_EQ(info.spacing, (std::array<double, 3>{0.125, 0.05, 0.05}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{-0.375, -1.15, -1.15}));
  EXPECT_EQ(info.axis_labels, (std::array<std::string, 3>{"z", "y", "x"}));
  EXPECT_EQ(info.unit_si, 1.0);
  EXPECT_EQ(info.type, ScalarType::float64);
}

TEST_F(Hdf5Real, EnzoDensityIsBigEndian) {
  take("enzo_amr_moving7_0010.cpu0000.h5");
  if (IsSkipped()) return;
  write_by_h5py(scratch_, R"(
f = h5py.File("enzo_amr_moving7_0010.cpu0000.h5")
expect("density", f["/Grid00000001/Density"][...])
)");
  expect_reads(scratch_, "enzo_amr_moving7_0010.cpu0000.h5", dataset_options("Grid00000001/Density"), "density");
  const std::vector<float> values = expected(scratch_, "density");
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  EXPECT_NEAR(*least, 0.0997, 0.00005);
  EXPECT_NEAR(*most, 22.2, 0.05);
}

}  // namespace
}  // namespace weir::hdf5_real_test
