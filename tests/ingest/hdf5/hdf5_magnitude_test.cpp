// Tests the lengths of vectors that have each component in a dataset of its own.
#include <algorithm>
#include <cmath>

#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_magnitude_test {
namespace {

SourceOptions lengths_of(std::vector<std::string> datasets, std::vector<std::int64_t> index = {}) {
  SourceOptions options = dataset_options({}, std::move(index));
  options.magnitude = std::move(datasets);
  return options;
}

class Hdf5Magnitude : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }

  std::string error_of(const SourceOptions& options) const {
    try {
      open_source(scratch_.path("a.h5"), options);
      return "no error";
    } catch (const Error& error) {
      return error.what();
    }
  }

  Scratch scratch_;
};

TEST_F(Hdf5Magnitude, WhateverTheStorageOfEachComponent) {
  write_by_h5py(scratch_, R"(
u, v, w = (values("f4") for _ in range(3))
expect("m3", np.sqrt(u.astype("f8") ** 2 + v.astype("f8") ** 2 + w.astype("f8") ** 2))
expect("m2", np.sqrt(u.astype("f8") ** 2 + w.astype("f8") ** 2))
with h5py.File("a.h5", "w") as f:
    f["u"] = u
    f["v"] = v.astype(">f4")
    f["w"] = w
    for name, data, chunks in (("gu", u, (2, 3, 4)), ("gv", v, (2, 3, 4)), ("gw", w, (5, 7, 9))):
        f.create_dataset(name, data=data, chunks=chunks, compression="gzip")
)");
  expect_reads(scratch_, "a.h5", lengths_of({"u", "v", "w"}), "m3");
  expect_reads(scratch_, "a.h5", lengths_of({"gu", "gv", "w"}), "m3");
  expect_reads(scratch_, "a.h5", lengths_of({"gu", "gv", "gw"}), "m3");
  expect_reads(scratch_, "a.h5", lengths_of({"u", "gw"}), "m2");
  const auto source = open_source(scratch_.path("a.h5"), lengths_of({"u", "v", "w"}));
  EXPECT_EQ(source->info().dataset, "/u,/v,/w");
  EXPECT_TRUE(source->info().lengths);
  EXPECT_EQ(source->info().details.component, "magnitude");
  EXPECT_EQ(source->access().bytes_per_voxel, 12U);
}

TEST_F(Hdf5Magnitude, OfComponentsThatLackChunks_SaysWhich) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name, written in ("u", 8), ("v", 4), ("w", 4):
        f.create_dataset(name, (2, 4, 8), "f4", chunks=(2, 4, 4), fillvalue=-7)[:, :, :written] = 1
)");
  const auto note = [&](const SourceOptions& options) {
    return open_source(scratch_.path("a.h5"), options)->info().details.chunks_note;
  };
  const std::string lacks = ": 1 of its 2 chunks was never written and reads as its fill value, -7";
  EXPECT_EQ(note(lengths_of({"u", "v", "w"})), "/v" + lacks + "; /w" + lacks);
}

TEST_F(Hdf5Magnitude, TypesLargeNumbersAndPositions) {
  write_by_h5py(scratch_, R"(
u, v = values("i2", (2,) + SHAPE), values("f8", (2,) + SHAPE)
v[1, 0, 0, :4] = 1e30, -1e200, np.nan, np.inf
big = v.astype("f4").astype("f8")
with np.errstate(over="ignore"): expect("m", np.sqrt(np.minimum(u[1].astype("f8") ** 2 + big[1] ** 2, 1e300)))
with h5py.File("a.h5", "w") as f:
    f["u"], f["v"] = u, v
)");
  const auto source = open_source(scratch_.path("a.h5"), lengths_of({"u", "v"}, {1}));
  const std::vector<float> values = all_values(*source);
  const std::vector<float> by_numpy = expected(scratch_, "m");
  ASSERT_EQ(values.size(), by_numpy.size());
  for (std::size_t i = 4; i < values.size(); ++i) ASSERT_EQ(values[i], by_numpy[i]) << i;
  EXPECT_EQ(values[0], 1e30F);
  EXPECT_EQ(values[1], std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(values[2]));
  EXPECT_EQ(values[3], std::numeric_limits<float>::infinity());
}

TEST_F(Hdf5Magnitude, RoundedComponents_BoundWhatLengthsLose) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name in "uvw": f[name] = np.full((16, 16, 16), 1 + 0.99 * 2.0 ** -25)
)");
  const auto source = open_source(scratch_.path("a.h5"), lengths_of({"u", "v", "w"}));
  std::vector<float> values(16 * 16 * 16);
  const ConversionLoss loss = source->read({{0, 0, 0}, {16, 16, 16}}, values);
  EXPECT_EQ(loss.inexact, 4096U);
  const double lost = std::abs(static_cast<double>(values[0]) - std::sqrt(3.0) * (1 + 0.99 * 0x1p-25));
  EXPECT_GE(loss.max_abs_error, lost);
  EXPECT_LE(loss.max_abs_error, 2 * lost);
}

TEST_F(Hdf5Magnitude, AVoxelWithoutOneComponentIsMissing) {
  write_by_h5py(scratch_, R"(
u, v = values("f4"), values("f4")
u[0, 0, 1] = -999; v[0, 0, 2] = 1e20
with h5py.File("a.h5", "w") as f:
    f["u"], f["v"] = u, v
    f["u"].attrs["_FillValue"] = np.float32(-999)
    f["v"].attrs["_FillValue"] = np.float32(1e20)
)");
  const auto source = open_source(scratch_.path("a.h5"), lengths_of({"u", "v"}));
  const std::vector<float> values = all_values(*source);
  EXPECT_FALSE(is_missing(values[0]));
  EXPECT_TRUE(is_missing(values[1]));
  EXPECT_TRUE(is_missing(values[2]));
  EXPECT_TRUE(source->info().mapping.marks_missing());
}

TEST_F(Hdf5Magnitude, TheFilesOfEveryComponentCount) {
  write_by_h5py(scratch_, R"(
v = values("f4")
open("outside", "wb").write(v.tobytes())
with h5py.File("a.h5", "w") as f:
    f["u"] = values("f4")
    f.create_dataset("v", SHAPE, "f4", external="outside")
)");
  const SourceInfo both = open_source(scratch_.path("a.h5"), lengths_of({"u", "v"}))->info();
  const SourceInfo alone = open_source(scratch_.path("a.h5"), dataset_options("u"))->info();
  EXPECT_NE(both.files_digest, alone.files_digest);
  EXPECT_TRUE(std::ranges::any_of(both.files, [](const FileState& file) { return file.path.ends_with("outside"); }));
}

TEST_F(Hdf5Magnitude, RefusesOtherUnitsAndKeptMissingValues) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name, units in (("u", "m/s"), ("v", "cm/s"), ("w", "m/s")):
        f[name] = values("f4")
        f[name].attrs["units"] = units
)");
  const std::string path = scratch_.path("a.h5");
  EXPECT_EQ(error_of(lengths_of({"u", "v"})),
            path + ": '/u' is in m/s and '/v' in cm/s, so that no length is made of them; convert them one by one");
  EXPECT_EQ(open_source(path, lengths_of({"u", "w"}))->info().units, "m/s");
  SourceOptions keeping = lengths_of({"u", "w"});
  keeping.keeps_missing = true;
  EXPECT_EQ(error_of(keeping), path +
                                   ": --magnitude makes no length of values that stand for \"no data\"; leave out "
                                   "--missing-policy keep");
}

TEST_F(Hdf5Magnitude, RefusesOtherVoxelsAndUnknownNames) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["u"], f["v"], f["w"] = values("f4"), values("f4", (5, 7, 8)), values("f4")
)");
  const std::string path = scratch_.path("a.h5");
  EXPECT_EQ(error_of(lengths_of({"u", "v"})),
            path +
                ": '/u' has 9 x 7 x 5 voxels of 1, 1, 1 at 0, 0, 0 and '/v' 8 x 7 x 5 voxels of 1, 1, 1 at 0, 0, 0, "
                "not the same ones; take the components to the same grid, or convert them one by one");
  EXPECT_NE(error_of(lengths_of({"u", "nothing"})).find("nothing"), std::string::npos);
}

}  // namespace
}  // namespace weir::hdf5_magnitude_test
