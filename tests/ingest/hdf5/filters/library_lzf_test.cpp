// Datasets packed by lzf that weir reads through the HDF5 library, which has no lzf filter of its own.
#include "ingest/hdf5/filters/library_lzf.h"

#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::library_lzf_test {
namespace {

class LibraryLzf : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }

  Scratch scratch_;
};

TEST_F(LibraryLzf, TimeBetweenTheAxesOfSpace_IsRead) {
  write_by_h5py(scratch_, R"(
v = values("i2", (5, 3, 7, 9)) // 64; expect("v", v[:, 1])
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("v", data=v, chunks=(2, 2, 7, 9), compression="lzf", shuffle=True)
    for axis, name in enumerate(["z", "time", "y", "x"]): d.dims[axis].label = name
)");
  expect_reads(scratch_, "a.h5", dataset_options("v", {1}), "v");
}

TEST_F(LibraryLzf, SourceOfAVirtualDataset_IsRead) {
  write_by_h5py(scratch_, R"(
v = values("i2") // 64; expect("v", v)
with h5py.File("source.h5", "w") as f: f.create_dataset("d", data=v, chunks=(2, 7, 9), compression="lzf", fletcher32=True)
layout = h5py.VirtualLayout(SHAPE, "i2"); layout[...] = h5py.VirtualSource("source.h5", "d", SHAPE)
with h5py.File("a.h5", "w") as f: f.create_virtual_dataset("v", layout)
)");
  expect_reads(scratch_, "a.h5", dataset_options("v"), "v");
}

TEST_F(LibraryLzf, Coordinates_GiveSpacingAndOrigin) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = values("f4")
    z = f.create_dataset("z", data=np.arange(5.0) * 2 + 10, compression="lzf")
    z.make_scale("z"); f["v"].dims[0].attach_scale(z)
)");
  const SourceInfo info = open_source(scratch_.path("a.h5"), dataset_options("v"))->info();
  EXPECT_EQ(info.spacing[2], 2);
  EXPECT_EQ(info.origin[2], 10);
}

TEST_F(LibraryLzf, StreamThatEndsEarly_IsAnError) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("v", data=np.ones((4, 3, 4, 4), "f4"), chunks=(4, 3, 4, 4), compression="lzf")
    for axis, name in enumerate(["z", "time", "y", "x"]): d.dims[axis].label = name
    d.id.write_direct_chunk((0, 0, 0, 0), b"\x02xyz", filter_mask=0)
)");
  const auto source = open_source(scratch_.path("a.h5"), dataset_options("v", {0}));
  const std::string message = message_of_error(ErrorKind::input, [&] { all_values(*source); });
  EXPECT_TRUE(message.starts_with(scratch_.path("a.h5") + ": /v: cannot be read at ")) << message;
}

TEST_F(LibraryLzf, BesideAFilterThatChangesTheSize_IsNotOffered) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name, more in (("alone", {}), ("beside", {"scaleoffset": 0})):
        f.create_dataset(name, data=np.ones((4, 4, 4), "i4"), chunks=(2, 4, 4), compression="lzf", **more)
)");
  open_source(scratch_.path("a.h5"), dataset_options("alone"));
  const std::string message =
      message_of_error(ErrorKind::input, [&] { open_source(scratch_.path("a.h5"), dataset_options("beside")); });
  EXPECT_EQ(message, scratch_.path("a.h5") +
                         ": /beside: packed by the filter lzf (32000), and no plugin for it is found; set "
                         "HDF5_PLUGIN_PATH to the directory that has it");
}

}  // namespace
}  // namespace weir::library_lzf_test
