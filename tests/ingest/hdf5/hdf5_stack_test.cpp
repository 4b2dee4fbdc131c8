// Tests stacks of files with coordinates that fall or that point down.
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_stack_test {
namespace {

TEST(Hdf5Stack, OfFallingPlanes_RisesThroughAllFiles) {
  if (!python_has("h5py, numpy, netCDF4")) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
  const Scratch scratch;
  write_by_h5py(scratch, R"(
import netCDF4
for number, first in enumerate([15, 7]):
    n = netCDF4.Dataset("s_%d.nc" % number, "w")
    for name, size in [("z", 8), ("y", 2), ("x", 3)]: n.createDimension(name, size)
    z = np.arange(first, first - 8, -1)
    n.createVariable("z", "f8", ("z",))[:] = z
    n.createVariable("t", "f4", ("z", "y", "x"))[:] = np.broadcast_to(z[:, None, None], (8, 2, 3))
    n.close()
)");
  SourceOptions options;
  options.stack = true;
  const auto source = open_source(scratch.path("s_%d.nc"), options);
  EXPECT_EQ(source->info().origin[2], 0);
  EXPECT_EQ(source->info().spacing[2], 1);
  EXPECT_EQ(source->info().details.axes[2].note,
            "falls from 15 to 0: planes are read in reverse order, so that positions rise");
  const std::vector<float> values = all_values(*source);
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(values[i], static_cast<float>(i / 6)) << i;
}

// An axis that points down does not change the place of the volume, only the note on its orientation.
TEST(Hdf5Stack, OfPlanesOfADepth_LiesWhereTheySay) {
  if (!python_has("h5py, numpy, netCDF4")) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
  const Scratch scratch;
  write_by_h5py(scratch, R"(
import netCDF4
for number in range(3):
    n = netCDF4.Dataset("s_%d.nc" % number, "w")
    for name, size in [("depth", 1), ("y", 2), ("x", 3)]: n.createDimension(name, size)
    depth = n.createVariable("depth", "f8", ("depth",)); depth[:] = 10 + 5 * number; depth.positive = "down"
    n.createVariable("t", "f4", ("depth", "y", "x"))[:] = np.full((1, 2, 3), number)
    n.close()
)");
  SourceOptions options;
  options.stack = true;
  const SourceInfo info = open_source(scratch.path("s_%d.nc"), options)->info();
  EXPECT_EQ(info.origin[2], 10);
  EXPECT_EQ(info.spacing[2], 5);
  EXPECT_TRUE(info.details.orientation.starts_with("axis z (depth) points down")) << info.details.orientation;
}

TEST(Hdf5Stack, OfOneAndOfTwoPlanesOfADepth_IsOne) {
  if (!python_has("h5py, numpy, netCDF4")) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
  const Scratch scratch;
  write_by_h5py(scratch, R"(
import netCDF4
for number, depths in enumerate([[0], [10, 20]]):
    n = netCDF4.Dataset("s_%d.nc" % number, "w")
    for name, size in [("depth", len(depths)), ("y", 2), ("x", 3)]: n.createDimension(name, size)
    depth = n.createVariable("depth", "f8", ("depth",)); depth[:] = depths; depth.positive = "down"
    n.createVariable("t", "f4", ("depth", "y", "x"))[:] = np.full((len(depths), 2, 3), number)
    n.close()
)");
  SourceOptions options;
  options.stack = true;
  const SourceInfo info = open_source(scratch.path("s_%d.nc"), options)->info();
  EXPECT_EQ(info.extent.z, 3);
  EXPECT_EQ(info.spacing[2], 10);
}

TEST(Hdf5Stack, OfFilesThatLackChunks_SaysWhichAndHowMany) {
  if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  const Scratch scratch;
  write_by_h5py(scratch, R"(
for number in range(4):
    with h5py.File("s_%d.h5" % number, "w") as f:
        d = f.create_dataset("d", (2, 4, 8), "f4", chunks=(2, 4, 4), fillvalue=-7)
        d[:, :, : 8 if number == 0 else 4] = number
)");
  SourceOptions options;
  options.stack = true;
  EXPECT_EQ(
      open_source(scratch.path("s_%d.h5"), options)->info().details.chunks_note,
      scratch.path("s_1.h5") +
          ": 1 of its 2 chunks was never written and reads as its fill value, -7; 2 further files lack chunks, too");
}

TEST(Hdf5Stack, OfFilesThatLackChunks_CountsThoseOfTheRegion) {
  if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  const Scratch scratch;
  write_by_h5py(scratch, R"(
for number in range(3):
    with h5py.File("s_%d.h5" % number, "w") as f:
        d = f.create_dataset("d", (4, 4, 8), "f4", chunks=(2, 4, 4), fillvalue=-7)
        d[...] = number
        if number == 1:
            del f["d"]
            d = f.create_dataset("d", (4, 4, 8), "f4", chunks=(2, 4, 4), fillvalue=-7)
            d[:2] = number
)");
  const std::string stack = scratch.path("s_%d.h5");
  SourceOptions options;
  options.stack = true;
  options.missing_chunks = MissingChunks::error;
  const auto values_in = [&](const Box& region) {
    options.roi = region;
    return all_values(*open_source(stack, options));
  };
  EXPECT_EQ(values_in({{0, 0, 8}, {8, 4, 12}}), std::vector<float>(128, 2));
  EXPECT_EQ(values_in({{4, 0, 4}, {8, 4, 6}}), std::vector<float>(32, 1));
  options.roi = Box{{4, 0, 5}, {8, 4, 8}};
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(stack, options); }),
            scratch.path("s_1.h5") +
                ": /d: 1 of the region's 2 chunks was never written (the first at 2, 0, 4), and with --missing-chunks "
                "error all must be; write them, or use --missing-chunks fill");
  options.missing_chunks = MissingChunks::fill;
  EXPECT_EQ(open_source(stack, options)->info().details.chunks_note,
            scratch.path("s_1.h5") + ": 1 of the region's 2 chunks was never written and reads as its fill value, -7");
}

}  // namespace
}  // namespace weir::hdf5_stack_test
