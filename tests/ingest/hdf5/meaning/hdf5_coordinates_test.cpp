// Coordinate variables that are packed, damaged or of another length than their axis.
#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"
#include "tests/support/sanitized.h"

namespace weir::hdf5_coordinates_test {
namespace {

using Triple = std::array<double, 3>;

class Hdf5Coordinates : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy, netCDF4")) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
  }
  SourceInfo info_of(const std::string& dataset, std::vector<std::int64_t> index = {}) {
    return open_source(scratch_.path("a.nc"), dataset_options(dataset, std::move(index)))->info();
  }

  Scratch scratch_;
};

TEST_F(Hdf5Coordinates, OfPackedVariablesAreUnpacked) {
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("a.nc", "w")
for name, size in [("time", 3), ("z", 5), ("y", 7), ("x", 9)]: n.createDimension(name, size)
def coordinate(name, type, stored, **attributes):
    c = n.createVariable(name, type, (name,)); c.set_auto_maskandscale(False); c.setncatts(attributes); c[:] = stored
coordinate("time", "i2", [0, 1, 2], scale_factor=6.0, add_offset=1.0, units="hours since 2000-01-01")
coordinate("z", "i2", np.arange(5), scale_factor=0.5, add_offset=100.0)
coordinate("y", "i1", np.arange(-3, 4)[::-1], _Unsigned="false", scale_factor=2.0)
coordinate("x", "i1", (np.arange(9) + 124).astype("u1").view("i1"), _Unsigned="true")
v = n.createVariable("t", "f4", ("time", "z", "y", "x")); v[:] = values("f4", (3,) + SHAPE)
n.close()
)");
  const SourceInfo info = info_of("t", {1});
  EXPECT_EQ(info.spacing, (Triple{1, 2, 0.5}));
  EXPECT_EQ(info.origin, (Triple{124, -6, 100}));
  EXPECT_TRUE(info.details.axes[1].reversed);
  ASSERT_TRUE(info.details.time.has_value());
  EXPECT_EQ(info.details.time->value, 7);
}

TEST_F(Hdf5Coordinates, BehindAFilterThatIsNotThere_AreAnErrorThatNamesIt) {
  const LeaksOfLibraries of_plugins;
  write_by_h5py(scratch_, R"(
with h5py.File("a.nc", "w") as f:
    f["t"] = values("f4")
    made = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    made.set_chunk((5,)); made.set_filter(32028, h5py.h5z.FLAG_OPTIONAL, ())
    z = h5py.Dataset(h5py.h5d.create(f.id, b"z", h5py.h5t.IEEE_F32LE, h5py.h5s.create_simple((5,)), made))
    z.id.write_direct_chunk((0,), np.arange(5, dtype="f4").tobytes(), filter_mask=0)
    z.make_scale("z"); f["t"].dims[0].attach_scale(z)
)");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { info_of("t"); }),
            scratch_.path("a.nc") +
                ": /z: its coordinates cannot be read: packed by the filter sperr (32028), and no plugin for it is "
                "found; set HDF5_PLUGIN_PATH to the directory that has it");
}

TEST_F(Hdf5Coordinates, InPackedChunksBeyondMemory_AreNotReadAndSaid) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.nc", "w") as f:
    f["t"] = values("f4")
    z = f.create_dataset("z", data=np.arange(5.0) * 2, maxshape=(None,), chunks=(2097153,), compression="gzip")
    z.make_scale("z"); f["t"].dims[0].attach_scale(z)
)");
  const SourceInfo info = info_of("t");
  EXPECT_EQ(info.spacing[2], 1);
  EXPECT_EQ(info.details.axes[2].note,
            "its coordinates lie in packed chunks of 2097153, and at most 2097152 are read, taken as indices");
}

TEST_F(Hdf5Coordinates, ThatGiveNoPlacesAreSaid) {
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("a.nc", "w")
for name, size in [("z", 5), ("y", 7), ("x", 9)]: n.createDimension(name, size)
for name, stored in [("z", [0, 1, 2, -9, 4]), ("y", [0, 1, np.nan, 3, 4, 5, 6]), ("x", np.arange(9))]:
    c = n.createVariable(name, "f4", (name,), fill_value=-9.0 if name == "z" else None); c.set_auto_maskandscale(False)
    c[:] = stored
    if name == "x": c.scale_factor = "half"
n.createVariable("t", "f4", ("z", "y", "x"))[:] = values("f4")
n.close()
)");
  const SourceInfo info = info_of("t");
  EXPECT_EQ(info.spacing, (Triple{1, 1, 1}));
  EXPECT_EQ(info.origin, (Triple{0, 0, 0}));
  const auto& axes = info.details.axes;
  EXPECT_EQ(axes[0].note, "its coordinates are no row of numbers, or packed by no number, taken as indices");
  EXPECT_EQ(axes[1].note, "coordinates that are missing or not finite, taken as indices");
  EXPECT_EQ(axes[2].note, "coordinates that are missing or not finite, taken as indices");
  for (const AxisDetails& axis : axes) EXPECT_TRUE(axis.coordinates.empty());
}

TEST_F(Hdf5Coordinates, InOrderHaveNoneMissing) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.nc", "w") as f:
    d = f.create_dataset("t", data=values("f4"))
    for axis, (name, attribute, value) in enumerate([("z", "_FillValue", 0.0), ("y", "missing_value", np.bytes_("none"))]):
        f[name] = np.arange(SHAPE[axis]) * 2.0; f[name].make_scale(name); f[name].attrs[attribute] = value
        d.dims[axis].attach_scale(f[name])
)");
  const SourceInfo info = info_of("t");
  EXPECT_EQ(info.spacing, (Triple{1, 2, 2}));
  EXPECT_EQ(info.details.axes[1].note + info.details.axes[2].note, "");
}

TEST_F(Hdf5Coordinates, OfTheEdgesOfCellsAreSaid) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.nc", "w") as f:
    d = f.create_dataset("t", data=values("f4"))
    f["edges"] = np.arange(10) * 0.5; f["edges"].make_scale("edges"); d.dims[2].attach_scale(f["edges"])
)");
  const SourceInfo info = info_of("t");
  EXPECT_EQ(info.spacing[0], 1);
  EXPECT_EQ(info.details.axes[0].note, "it has 10 coordinates for 9 elements, taken as indices");
}

TEST_F(Hdf5Coordinates, OfMoreElements_AreTheFirstWhereArrayAndCoordinatesGrow) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.nc", "w") as f:
    for name, limit in [("fixed", 7), ("open", None)]:
        d = f.create_dataset("t_" + name, data=values("f4"), maxshape=(None, 7, 9))
        s = f.create_dataset("z_" + name, data=np.arange(7) * 0.5, maxshape=(limit,)); s.make_scale("z_" + name); s.attrs["units"] = "m"
        d.dims[0].attach_scale(s)
)");
  EXPECT_EQ(info_of("t_fixed").details.axes[2].note, "it has 7 coordinates for 5 elements, taken as indices");
  const SourceInfo info = info_of("t_open");
  EXPECT_EQ(info.spacing[2], 0.5);
  EXPECT_EQ(info.details.axes[2].note, "");
  EXPECT_EQ(info.details.values_note,
            "its dimension z_open has 7 elements, of which 5 are written here: positions count these, and the last one "
            "is 4");
}

TEST_F(Hdf5Coordinates, UnsignedFalse_MeansSignedValues) {
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("a.nc", "w")
for name, size in [("z", 5), ("y", 7), ("x", 9)]: n.createDimension(name, size)
v = n.createVariable("t", "u1", ("z", "y", "x"), fill_value=255); v.set_auto_maskandscale(False); v._Unsigned = "false"
stored = values("u1"); stored[0, 0, 1] = 255; v[:] = stored
expect("t", stored.view("i1"))
n.close()
)");
  const auto source = open_source(scratch_.path("a.nc"), dataset_options("t"));
  EXPECT_EQ(source->info().type, ScalarType::int8);
  const std::vector<float> values = all_values(*source);
  const std::vector<float> wanted = expected(scratch_, "t");
  ASSERT_EQ(values.size(), wanted.size());
  EXPECT_TRUE(is_missing(values[1]));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (wanted[i] == -1) continue;  // stored as 255, the fill value
    ASSERT_EQ(values[i], wanted[i]) << i;
  }
}

TEST_F(Hdf5Coordinates, OfOpenPmdMeshesHaveAUnitForEachAxis) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.nc", "w") as f:
    def mesh(name, spacing, unit, **more):
        d = f.create_dataset(name, data=values("f4"))
        d.attrs.update(dict(gridSpacing=np.array(spacing), gridUnitSI=unit, gridGlobalOffset=np.zeros(len(spacing)),
                            axisLabels=np.array([b"z", b"y", b"x"][:len(spacing)]), **more))
    mesh("units", [1.0, 2.0, 3.0], np.array([1e-6, 1e-3, 1.0]), geometry=np.bytes_("cartesian"))
    mesh("one", [1.0, 2.0, 3.0], 0.5)
    mesh("short", [1.0, 2.0], 1.0)
    mesh("theta", [1.0, 2.0], 1.0, geometry=np.bytes_("thetaMode"))
)");
  EXPECT_EQ(info_of("units").spacing, (Triple{3, 2 * 1e-3, 1e-6}));
  EXPECT_EQ(info_of("one").spacing, (Triple{1.5, 1, 0.5}));
  EXPECT_EQ(info_of("short").details.axes[0].note,
            "its mesh's gridSpacing is not one for each of 3 axes, taken as indices");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { info_of("theta"); }),
            scratch_.path("a.nc") +
                ": /theta: its geometry is thetaMode (openPMD), and a volume's axes are Cartesian; sample it on a "
                "Cartesian mesh first");
}

TEST_F(Hdf5Coordinates, OfOneMagnitudeAreThoseOfAllComponents) {
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("a.nc", "w")
for name, size in [("z", 5), ("y", 7), ("other", 7), ("x", 9)]: n.createDimension(name, size)
n.createVariable("y", "f8", ("y",))[:] = np.arange(7) ** 2
n.createVariable("other", "f8", ("other",))[:] = np.arange(7) ** 3
for name, y in [("u", "y"), ("v", "other"), ("w", "y")]: n.createVariable(name, "f4", ("z", y, "x"))[:] = values("f4")
n.close()
)");
  const auto magnitude = [&](std::vector<std::string> datasets) {
    SourceOptions options;
    options.magnitude = std::move(datasets);
    return open_source(scratch_.path("a.nc"), options);
  };
  EXPECT_EQ(message_of_error(ErrorKind::input,
                             [&] {
                               magnitude({"u", "v"});
                             }),
            scratch_.path("a.nc") +
                ": '/u' and '/v' have other coordinates along y; take the components to the same grid, or convert "
                "them one by one");
  EXPECT_EQ(magnitude({"u", "w"})->info().details.axes[1].coordinates.size(), 7U);
}

TEST_F(Hdf5Coordinates, ThatPointDownAreKeptAndSaid) {
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("a.nc", "w")
for name, size, stored in [("depth", 5, np.arange(5) * 10.0), ("lev", 5, np.arange(5)[::-1] * 100.0), ("uneven", 5, [0, 1, 3, 7, 15]),
                           ("up", 5, np.arange(5) * 1.0), ("y", 7, np.arange(7)), ("x", 9, np.arange(9))]:
    n.createDimension(name, size); c = n.createVariable(name, "f8", (name,)); c[:] = stored
    if size == 5: c.positive = "up" if name == "up" else "down"
for name in ["depth", "lev", "uneven", "up"]: n.createVariable("in_" + name, "f4", (name, "y", "x"))[:] = np.broadcast_to(np.arange(5.0)[:, None, None], SHAPE)
n.close()
)");
  const auto first_value = [&](const char* name) {
    return all_values(*open_source(scratch_.path("a.nc"), dataset_options(name))).front();
  };
  const std::string said =
      " points down (positive = \"down\"): voxels lie where the file says, upside down where z is up; to turn them "
      "round, negate these coordinates in the file, or reverse the axis where they are irregular";
  EXPECT_EQ(info_of("in_depth").details.orientation, "axis z (depth)" + said);
  EXPECT_EQ(info_of("in_depth").origin[2], 0);
  EXPECT_EQ(first_value("in_depth"), 0.0F);
  const SourceInfo falling = info_of("in_lev");
  EXPECT_EQ(falling.details.orientation, "axis z (lev)" + said);
  EXPECT_EQ(falling.details.axes[2].note,
            "falls from 400 to 0: planes are read in reverse order, so that positions rise");
  EXPECT_EQ(first_value("in_lev"), 4.0F);
  EXPECT_EQ(info_of("in_uneven").details.orientation, "axis z (uneven)" + said);
  EXPECT_EQ(info_of("in_up").details.orientation, "");
}

}  // namespace
}  // namespace weir::hdf5_coordinates_test
