// Tests datasets and chunks to which nothing was ever written.
#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::unwritten_test {
namespace {

class Hdf5Unwritten : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy, netCDF4")) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
  }
  std::string refused(const std::string& file, const SourceOptions& options) const {
    return message_of_error(ErrorKind::input, [&] { open_source(scratch_.path(file), options); });
  }

  const std::string nothing_ = "no value was ever written to it; convert it when its values are there";
  Scratch scratch_;
};

TEST_F(Hdf5Unwritten, WithAFillValueOfItsWriter_IsThatThroughout) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f.create_dataset("contiguous", (4, 3, 2), ">i2", fillvalue=-3)
    f.create_dataset("series", (2, 4, 3, 2), "f4", fillvalue=0.5)
    f.create_dataset("vectors", (4, 3, 2, 3), "f4", fillvalue=2)
    f.create_dataset("chunked", (4, 3, 2), "f4", chunks=(2, 3, 2), compression="gzip", fillvalue=7.5)
    f["chunked"].attrs["scale_factor"] = 2.0
)");
  const auto expect_all = [&](const SourceOptions& options, float value, const std::string& note) {
    const auto source = open_source(scratch_.path("a.h5"), options);
    EXPECT_EQ(all_values(*source), std::vector<float>(24, value)) << options.dataset;
    EXPECT_EQ(source->info().details.chunks_note, note);
  };
  const std::string never = "its values were never written and read as its fill value, ";
  expect_all(dataset_options("contiguous"), -3, never + "-3");
  expect_all(dataset_options("series", {1}), 0.5, never + "0.5");
  SourceOptions vectors = dataset_options("vectors");
  vectors.component = ComponentChoice{false, 2};
  expect_all(vectors, 2, never + "2");
  expect_all(dataset_options("chunked"), 15, "2 of its 2 chunks were never written and read as its fill value, 15");
  for (const DatasetInfo& listed : list_hdf5(scratch_.path("a.h5"), {})) EXPECT_EQ(listed.obstacle, "") << listed.name;
}

TEST_F(Hdf5Unwritten, IsRefusedWhereAllMustBeWritten) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f: f.create_dataset("d", (4, 3, 2), "f4", fillvalue=1)
)");
  SourceOptions options = dataset_options("d");
  options.missing_chunks = MissingChunks::error;
  EXPECT_EQ(refused("a.h5", options),
            scratch_.path("a.h5") +
                ": /d: its values were never written, and with --missing-chunks error all must be; write them, or use "
                "--missing-chunks fill");
}

// FILL_TIME_NEVER is what NetCDF's NC_NOFILL sets. The library then leaves what is in memory for unwritten chunks.
TEST_F(Hdf5Unwritten, ChunkThatTheLibraryReads_IsTheFillValueThoughThatIsNeverWritten) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    p = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    p.set_chunk((8, 8, 8)); p.set_scaleoffset(h5py.h5z.SO_INT, 0)
    p.set_fill_value(np.array(-7, "i4")); p.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
    d = h5py.Dataset(h5py.h5d.create(f.id, b"d", h5py.h5t.STD_I32LE, h5py.h5s.create_simple((8, 8, 16)), p))
    d[:, :, :8] = 5
)");
  const auto source = open_source(scratch_.path("a.h5"), {});
  EXPECT_EQ(source->info().details.chunks_note, "1 of its 2 chunks was never written and reads as its fill value, -7");
  const std::vector<float> values = all_values(*source);
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(values[i], i % 16 < 8 ? 5 : -7) << i;
}

TEST_F(Hdf5Unwritten, ChunksOfOtherSteps_AreNotCounted) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("steps", (2, 41, 41, 41), "u1", chunks=(1, 1, 1, 1), fillvalue=3)
    d[0] = 1
    d = f.create_dataset("endless", (2, 102, 102, 102), "u1", chunks=(1, 1, 1, 1), fillvalue=3)
    d[0, 0, 0, 0] = 1
)");
  const auto note = [&](const std::string& name, std::int64_t step) {
    return open_source(scratch_.path("a.h5"), dataset_options(name, {step}))->info().details.chunks_note;
  };
  EXPECT_EQ(note("steps", 0), "");
  EXPECT_EQ(note("steps", 1), "68921 of its 68921 chunks were never written and read as its fill value, 3");
  EXPECT_EQ(note("endless", 0),
            "2122415 of all 2122416 chunks, some perhaps outside what is read, were never written and read as its fill "
            "value, 3");
}

// Each dataset is refused for a reason: nobody chose its fill value (`default`), the value means no data (`nan`,
// `missing`, `netcdf` and a.nc), or the library would leave what is in memory (`never`).
TEST_F(Hdf5Unwritten, IsRefusedWhereItsFillValueIsNoData) {
  write_by_h5py(scratch_, R"(
import netCDF4
with h5py.File("a.h5", "w") as f:
    f.create_dataset("default", (4, 3, 2), "f4")
    f.create_dataset("nan", (4, 3, 2), "f4", fillvalue=np.nan)
    f.create_dataset("missing", (4, 3, 2), "f4", chunks=(2, 3, 2), fillvalue=-9)
    f["missing"].attrs["missing_value"] = np.float32(-9)
    f.create_dataset("netcdf", (4, 3, 2), "f4", fillvalue=9.9692099683868690e36)
    p = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    p.set_fill_value(np.array(5, "f4")); p.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
    h5py.h5d.create(f.id, b"never", h5py.h5t.py_create(np.dtype("f4")), h5py.h5s.create_simple((4, 3, 2)), p)
n = netCDF4.Dataset("a.nc", "w")
for name, size in [("z", 4), ("y", 3), ("x", 2)]: n.createDimension(name, size)
for name, kind in [("byte", "i1"), ("float", "f4")]: n.createVariable(name, kind, ("z", "y", "x"))
n.close()
)");
  for (const char* name : {"default", "nan", "missing", "netcdf", "never"}) {
    EXPECT_EQ(refused("a.h5", dataset_options(name)), cat(scratch_.path("a.h5"), ": /", name, ": ", nothing_));
  }
  for (const char* name : {"byte", "float"}) {
    EXPECT_EQ(refused("a.nc", dataset_options(name)), cat(scratch_.path("a.nc"), ": /", name, ": ", nothing_));
  }
}

}  // namespace
}  // namespace weir::unwritten_test
