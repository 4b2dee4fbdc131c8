// Tests where volumes of HDF5 files lie and what their values mean. The files follow openPMD, NetCDF-4, VTKHDF and
// plain attributes, as the libraries of each convention write them.

#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_placement_test {
namespace {

using Triple = std::array<double, 3>;
using Labels = std::array<std::string, 3>;

class Hdf5Placement : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy, netCDF4")) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
  }
  SourceInfo info_of(const std::string& file, const std::string& dataset, std::vector<std::int64_t> index = {}) {
    return open_source(scratch_.path(file), dataset_options(dataset, std::move(index)))->info();
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

TEST_F(Hdf5Placement, OpenPmdIsPermutedWithTheAxes) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    def mesh(name, order, labels, spacing, offset, unit=1.0):
        g = f.create_group("data/100/meshes/" + name)
        g.attrs.update({"dataOrder": order, "axisLabels": np.array(labels, "S"), "gridSpacing": np.array(spacing, "f4"),
                        "gridGlobalOffset": offset, "gridUnitSI": unit, "geometry": "cartesian"})
        d = g.create_dataset("x", data=values("f8"))
        d.attrs.update({"unitSI": 2.5, "position": [0.0, 0.5, 0.25]})
        c = g.create_group("y")
        c.attrs.update({"value": 0.1, "shape": np.array(SHAPE, "u8"), "unitSI": 3.0})
        return g
    mesh("C", "C", ["z", "y", "x"], [4, 2, 1], [10, 20, 30])
    mesh("F", "F", ["x", "y", "z"], [1, 2, 4], [30, 20, 10], 0.5)
    d = f.create_dataset("data/100/meshes/rho", data=values("f8"))
    d.attrs.update({"axisLabels": np.array(["z", "y", "x"], "S"), "gridSpacing": [4., 2., 1.], "gridGlobalOffset": [1., 2., 3.]})
    d = f.create_dataset("data/100/meshes/odd", data=values("f8"))
    d.attrs.update({"axisLabels": "xyz", "gridSpacing": [4., 2.], "gridGlobalOffset": "here"})
)");
  const SourceInfo c = info_of("a.h5", "/data/100/meshes/C/x");
  EXPECT_EQ(c.axis_labels, (Labels{"x", "y", "z"}));
  EXPECT_EQ(c.spacing, (Triple{1, 2, 4}));
  EXPECT_EQ(c.origin, (Triple{30.25, 21, 10}));
  EXPECT_EQ(c.unit_si, 2.5);
  const SourceInfo f = info_of("a.h5", "/data/100/meshes/F/x");
  EXPECT_EQ(f.axis_labels, (Labels{"x", "y", "z"}));
  EXPECT_EQ(f.spacing, (Triple{0.5, 1, 2}));
  EXPECT_EQ(f.origin, (Triple{15, 10.5, 5.5}));
  const SourceInfo rho = info_of("a.h5", "/data/100/meshes/rho");
  EXPECT_EQ(rho.spacing, (Triple{1, 2, 4}));
  EXPECT_EQ(rho.origin, (Triple{3, 2, 1}));
  EXPECT_EQ(rho.unit_si, std::nullopt);
  EXPECT_EQ(info_of("a.h5", "/data/100/meshes/odd").spacing, (Triple{1, 1, 1}));

  const auto constant = open_source(scratch_.path("a.h5"), dataset_options("/data/100/meshes/C/y"));
  EXPECT_EQ(constant->info().extent, (Index3{9, 7, 5}));
  EXPECT_EQ(constant->info().type, ScalarType::float64);
  EXPECT_EQ(constant->info().spacing, (Triple{1, 2, 4}));
  std::vector<float> values(9);
  const ConversionLoss loss = constant->read({{0, 3, 2}, {9, 4, 3}}, values);
  EXPECT_EQ(values, std::vector<float>(9, 0.1F));
  EXPECT_EQ(loss.inexact, 9U);
  EXPECT_EQ(loss.max_abs_error, static_cast<double>(0.1F) - 0.1);
}

TEST_F(Hdf5Placement, TextThatIsTooLongForAUnit_IsNone) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f.create_dataset("short", data=values("f4")).attrs["units"] = "m" * 128
    f.create_dataset("long", data=values("f4")).attrs["units"] = "m" * 129
)");
  EXPECT_EQ(info_of("a.h5", "short").units, std::string(128, 'm'));
  EXPECT_EQ(info_of("a.h5", "long").units, "");
}

TEST_F(Hdf5Placement, NetcdfCoordinatesGiveSpacingAndNames) {
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("a.nc", "w")
for name, size in [("time", None), ("level", 5), ("lat", 7), ("lon", 9), ("bare", 9)]: n.createDimension(name, size)
def coordinate(name, values, type="f4"): n.createVariable(name, type, (name,))[:] = values
coordinate("time", [0, 6], "f8")
coordinate("level", [1000, 850, 500, 250, 100])
coordinate("lat", np.linspace(60, 30, 7))
coordinate("lon", np.linspace(-10, -9.2, 9))
v = n.createVariable("t", "f4", ("time", "level", "lat", "lon"), zlib=True)
v[:] = values("f4", (2,) + SHAPE); v.units = "K"
n.createVariable("u", "f4", ("level", "lat", "bare"))[:] = values("f4")
n.close()
)");
  const SourceInfo t = info_of("a.nc", "t", {1});
  EXPECT_EQ(t.dataset, "/t");
  EXPECT_EQ(t.index, (std::vector<std::int64_t>{1}));
  EXPECT_EQ(t.axis_labels, (Labels{"lon", "lat", "level"}));
  EXPECT_EQ(t.units, "K");
  EXPECT_NEAR(t.spacing[0], 0.1, 1e-6);
  EXPECT_NEAR(t.origin[0], -10, 1e-6);
  EXPECT_EQ(t.spacing[1], 5);
  EXPECT_EQ(t.origin[1], 30);
  EXPECT_EQ(t.spacing[2], 1);
  EXPECT_EQ(t.origin[2], 0);
  EXPECT_EQ(attribute("a.nc", "/t", "axis y"),
            "falls from 60 to 30: rows are read in reverse order, so that positions rise");
  EXPECT_EQ(attribute("a.nc", "/t", "axis z"), "irregular coordinates from 1000 to 100, taken as indices");
  EXPECT_EQ(attribute("a.nc", "/t", "axes"), "time=2 x level=5 x lat=7 x lon=9");
  EXPECT_TRUE(t.details.axes[1].reversed);
  EXPECT_FALSE(t.details.axes[2].reversed);
  const SourceInfo u = info_of("a.nc", "u");
  EXPECT_EQ(u.axis_labels, (Labels{"bare", "lat", "level"}));
  EXPECT_EQ(u.spacing[0], 1);
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { info_of("a.nc", "t"); }),
            scratch_.path("a.nc") +
                ": /t: its axes are time=2 x level=5 x lat=7 x lon=9, and a volume has three; give "
                "--index with 1 position: time in 0..1");
  // The dimension `bare` has no coordinates, so it is not listed as a dataset.
  for (const DatasetInfo& listed : list_hdf5(scratch_.path("a.nc"), {})) EXPECT_NE(listed.name, "/bare");
}

TEST_F(Hdf5Placement, FallingCoordinates_ReverseTheElementsOfEveryStorage) {
  write_by_h5py(scratch_, R"(
v = values("f4"); w = values("i2", SHAPE + (3,))
expect("v", v[::-1, :, ::-1]); expect("w", w[::-1, :, ::-1, 2])
falling = {0: [5, 4, 3, 2, 1], 1: [0, 1, 2, 3, 4, 5, 6], 2: np.arange(9, 0, -1) / 2}
with h5py.File("a.h5", "w") as f:
    for axis, coordinates in falling.items():
        f["c%d" % axis] = np.asarray(coordinates, "f8"); f["c%d" % axis].make_scale()
    def field(name, data, **layout):
        d = f.create_dataset(name, data=data, **layout)
        for axis in falling: d.dims[axis].attach_scale(f["c%d" % axis])
    field("contiguous", v); field("gzip", v, chunks=(2, 3, 4), compression="gzip"); field("szip", v, chunks=(5, 7, 9), compression="szip")
    field("vectors", w, chunks=(2, 3, 4, 3), compression="gzip")
)");
  for (const char* name : {"contiguous", "gzip", "szip"}) expect_reads(scratch_, "a.h5", dataset_options(name), "v");
  SourceOptions z = dataset_options("vectors");
  z.component = ComponentChoice{false, 2};
  expect_reads(scratch_, "a.h5", z, "w");
  const SourceInfo info = info_of("a.h5", "gzip");
  EXPECT_EQ(info.spacing, (Triple{0.5, 1, 1}));
  EXPECT_EQ(info.origin, (Triple{0.5, 0, 1}));
  EXPECT_EQ(info.details.axes[0].note,
            "falls from 4.5 to 0.5: columns are read in reverse order, so that positions rise");
  EXPECT_EQ(info.details.axes[2].note, "falls from 5 to 1: planes are read in reverse order, so that positions rise");
}

TEST_F(Hdf5Placement, NetcdfPackingAndMissingValues) {
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("a.nc", "w")
for name, size in [("z", 5), ("y", 7), ("x", 9)]: n.createDimension(name, size)
def make(name, type, data, fill=None, **attributes):
    v = n.createVariable(name, type, ("z", "y", "x"), fill_value=fill)
    v.set_auto_maskandscale(False)
    v.setncatts(attributes)
    v[:] = data
    return v
raw = rng.integers(-100, 100, SHAPE).astype("i2"); raw[0, 0, 0] = -99; raw[1, 1, 1] = 98
make("packed", "i2", raw, -99, scale_factor=0.5, add_offset=10.0, missing_value=np.array([98, 97], "i2"))
expect("packed", raw * 0.5 + 10.0)
f = values("f4"); f[2, 3, 4] = 1e20
make("marked", "f4", f, None, missing_value=1e20)
expect("marked", f)
d = n.createVariable("unwritten", "f4", ("z", "y", "x"), chunksizes=(1, 7, 9))
d[0] = 1.0
make("text", "f4", values("f4"), None, missing_value="-999", scale_factor="2")
make("bad", "f4", values("f4"), None, scale_factor="half")
make("zero", "f4", values("f4"), None, scale_factor=0.0)
make("list", "f4", values("f4"), None, add_offset=[1.0, 2.0])
n.close()
)");
  const auto packed = open_source(scratch_.path("a.nc"), dataset_options("packed"));
  const std::vector<float> values = all_values(*packed);
  const std::vector<float> plain = expected(scratch_, "packed");
  int missing = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool marked = plain[i] == -99 * 0.5F + 10 || plain[i] == 98 * 0.5F + 10 || plain[i] == 97 * 0.5F + 10;
    missing += marked ? 1 : 0;
    EXPECT_EQ(is_missing(values[i]), marked);
    if (!marked) {
      EXPECT_EQ(values[i], plain[i]);
    }
  }
  EXPECT_GE(missing, 2);
  EXPECT_EQ(attribute("a.nc", "/packed", "values"), "stored * 0.5 + 10");
  EXPECT_EQ(attribute("a.nc", "/packed", "missing"), "-99, 98, 97");

  const std::vector<float> marked = all_values(*open_source(scratch_.path("a.nc"), dataset_options("marked")));
  EXPECT_TRUE(is_missing(marked[2 * 63 + 3 * 9 + 4]));
  EXPECT_EQ(marked[0], expected(scratch_, "marked")[0]);

  // NetCDF's tools take its own fill value as missing, and so does weir.
  const std::vector<float> unwritten = all_values(*open_source(scratch_.path("a.nc"), dataset_options("unwritten")));
  EXPECT_EQ(unwritten[62], 1.0F);
  EXPECT_TRUE(is_missing(unwritten[63]));

  const SourceInfo text = info_of("a.nc", "text");
  EXPECT_EQ(text.mapping.scale, 2);
  ASSERT_EQ(text.mapping.missing.size(), 2U);
  EXPECT_EQ(as_double(text.mapping.missing[0]), -999);
  EXPECT_EQ(as_double(text.mapping.missing[1]), 9.9692099683868690e+36) << "NetCDF's own, beside missing_value";
  const auto refused = [&](const char* name) {
    return message_of_error(ErrorKind::input, [&] { info_of("a.nc", name); });
  };
  const std::string unknown = ", so what its values mean is unknown; correct or remove it";
  EXPECT_EQ(refused("bad"), scratch_.path("a.nc") +
                                ": /bad: its attribute scale_factor is 'half' and not one finite number other than 0" +
                                unknown);
  EXPECT_EQ(refused("zero"), scratch_.path("a.nc") +
                                 ": /zero: its attribute scale_factor is 0 and not one finite number other than 0" +
                                 unknown);
  EXPECT_EQ(refused("list"), scratch_.path("a.nc") +
                                 ": /list: its attribute add_offset is 2 values (1, 2) and not one finite number" +
                                 unknown);
}

TEST_F(Hdf5Placement, ScaleFactorThatIsNoNumber_IsShown) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name, scale in [("nan", np.nan), ("list", [1, 2, 3, 4, 5]), ("complex", 1 + 2j), ("bool", True),
                        ("none", h5py.Empty("f4"))]:
        f[name] = values("f4")
        f[name].attrs["scale_factor"] = scale
)");
  for (const auto& [name, found] :
       std::vector<std::pair<std::string, std::string>>{{"nan", "nan"},
                                                        {"list", "5 values (1, 2, 3, 4, ...)"},
                                                        {"complex", "of type compound of 2 members"},
                                                        {"bool", "of type boolean"},
                                                        {"none", "empty"}}) {
    EXPECT_EQ(message_of_error(ErrorKind::input, [&, name = name] { info_of("a.h5", name); }),
              scratch_.path("a.h5") + ": /" + name + ": its attribute scale_factor is " + found +
                  " and not one finite number other than 0, so what its values mean is unknown; correct or remove it");
  }
}

TEST_F(Hdf5Placement, OptionsAddToTheAttributesOfTheFile) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("v", data=np.arange(8, dtype="i4").reshape(2, 2, 2))
    d.attrs["_FillValue"] = np.int32(3)
    d.attrs["spacing"] = [1.0, 2.0, 3.0]
)");
  SourceOptions options = dataset_options("v");
  options.missing = StoredValue{std::int64_t{5}};
  options.origin = {7.0, 8.0, 9.0};
  const auto source = open_source(scratch_.path("a.h5"), options);
  EXPECT_EQ(source->info().spacing, (Triple{1, 2, 3}));
  EXPECT_EQ(source->info().origin, (Triple{7, 8, 9}));
  const std::vector<float> values = all_values(*source);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(is_missing(values[i]), i == 3 || i == 5);
}

// "VTKHDF File Format", ImageData: Origin is the position of point 0,0,0, but WholeExtent may begin at any point. Cells
// lie between points. The columns of Direction are the directions of the axes.
TEST_F(Hdf5Placement, VtkHdfPointsLieOnTheLatticeAndCellsHalfASpacingOn) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.vtkhdf", "w") as f:
    def image(name, **more):
        g = f.create_group(name)
        g.attrs.update({"Type": np.bytes_("ImageData"), "Origin": [10.0, 20.0, 30.0], "Spacing": [2.0, 4.0, 8.0], **more})
        g["PointData/p"] = values("f4", (2, 3, 4))
        g["CellData/c"] = values("f4", (1, 2, 3))
    image("VTKHDF", WholeExtent=[0, 3, 0, 2, 0, 1])
    image("later", WholeExtent=[5, 8, 0, 2, -1, 0])
    image("turned", WholeExtent=[0, 3, 0, 2, 0, 1], Direction=[0.0, -1, 0, 1, 0, 0, 0, 0, 1])
    image("flat", WholeExtent=[0, 3, 0, 2, 5, 5])
)");
  const auto origin = [&](const std::string& name) { return info_of("a.vtkhdf", name).origin; };
  EXPECT_EQ(info_of("a.vtkhdf", "VTKHDF/CellData/c").spacing, (Triple{2, 4, 8}));
  EXPECT_EQ(origin("VTKHDF/PointData/p"), (Triple{10, 20, 30}));
  EXPECT_EQ(origin("VTKHDF/CellData/c"), (Triple{11, 22, 34}));
  EXPECT_EQ(origin("later/PointData/p"), (Triple{20, 20, 22}));
  EXPECT_EQ(origin("later/CellData/c"), (Triple{21, 22, 26}));
  EXPECT_EQ(origin("turned/CellData/c"), (Triple{21, 8, 34}));
  EXPECT_EQ(origin("flat/CellData/c"), (Triple{11, 22, 70})) << "cells of one layer of points lie in it";
}

// CF conventions, 4: a coordinate variable gives the locations of the values themselves. `bounds` gives the cells
// around them and moves no value. openPMD 1.1: the first cell begins at gridGlobalOffset. `position` is the place of a
// value in its cell, from 0 to 1.
TEST_F(Hdf5Placement, CoordinatesAndOpenPmdPositionsAreOfVoxelCentres) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    v = f.create_dataset("v", data=values("f4", (2, 3, 4)))
    for axis, (name, first, step) in enumerate([("z", 30, 8), ("y", 20, 4), ("x", 10, 2)]):
        n = v.shape[axis]
        f[name] = first + step * np.arange(n, dtype="f8")
        f[name].attrs["bounds"] = name + "_bounds"
        f[name + "_bounds"] = np.stack([f[name][:] - step / 2, f[name][:] + step / 2], axis=1)
        f[name].make_scale(name)
        v.dims[axis].attach_scale(f[name])
    for name, position in (("node", [0.0] * 3), ("cell", [0.5] * 3)):
        d = f.create_dataset("data/0/meshes/" + name, data=values("f4", (2, 3, 4)))
        d.attrs.update({"axisLabels": np.array(["z", "y", "x"], "S"), "gridSpacing": [8., 4., 2.],
                        "gridGlobalOffset": [30., 20., 10.], "position": position})
)");
  EXPECT_EQ(info_of("a.h5", "v").origin, (Triple{10, 20, 30}));
  EXPECT_EQ(info_of("a.h5", "/data/0/meshes/node").origin, (Triple{10, 20, 30}));
  EXPECT_EQ(info_of("a.h5", "/data/0/meshes/cell").origin, (Triple{11, 22, 34}));
}

// The attributes have every name that weir looks for, in every shape and type. Nothing crashes, and each volume opens
// or is refused in one line.
TEST_F(Hdf5Placement, AttributesOfAnyTypeCauseNoCrash) {
  write_by_h5py(scratch_, R"(
names = ["_FillValue", "missing_value", "scale_factor", "add_offset", "units", "Units", "unitSI", "position", "value", "shape",
         "gridSpacing", "gridGlobalOffset", "gridUnitSI", "axisLabels", "dataOrder", "DIMENSION_LIST", "CLASS", "NAME",
         "spacing", "origin", "voxel_size", "resolution", "offset", "long_name", "_NCProperties"]
with h5py.File("a.h5", "w") as f:
    def kinds(ref):
        return [np.float32(2), np.array([1., 2, 3]), np.zeros((2, 2)), np.arange(5000.), "text", "", np.array(["a", "bc"], "S2"),
                np.array([b"x"] * 3), h5py.Empty("f4"), h5py.Empty("S4"), np.array([(1, 2.)], "i4,f4"), np.bool_(True), np.int64(-1),
                np.uint64(2**64 - 1), ref, np.array([ref, ref, ref], h5py.ref_dtype), np.void(b"abc"), np.longdouble(1), np.nan,
                np.array([np.inf, -np.inf, 0]), 1e400, "x" * 40000, np.float16(2), np.zeros(3, "c8")]
    f["target"] = 1.0
    for i, value in enumerate(kinds(f["target"].ref)):
        d = f.create_dataset("set%d/v" % i, data=values("f4", (2, 3, 4)))
        g = f.create_group("set%d/constant" % i)
        unscaled = f.create_dataset("set%d/unscaled" % i, data=values("f4", (2, 3, 4)))
        unmarked = f.create_dataset("set%d/unmarked" % i, data=values("f4", (2, 3, 4)))
        for o in (d, g, unscaled, unmarked):
            for name in names: o.attrs[name] = value
            o.attrs.create("axisLabels", ["a", "b", "c"], dtype=h5py.string_dtype())
        for name in ("scale_factor", "add_offset"): del unscaled.attrs[name]
        for name in names[:4]: del unmarked.attrs[name]
    d = f.create_dataset("scales", data=values("f4", (2, 3, 4)))
    d.attrs.create("DIMENSION_LIST", np.array([np.array([f["target"].ref]), np.array([]), np.array([f.ref, d.ref])], dtype=object),
                   dtype=h5py.vlen_dtype(h5py.ref_dtype))
)");
  int opened = 0;
  for (const DatasetInfo& listed : list_hdf5(scratch_.path("a.h5"), {})) {
    try {
      all_values(*open_source(scratch_.path("a.h5"), dataset_options(listed.name)));
      ++opened;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(opened, 20);
}

}  // namespace
}  // namespace weir::hdf5_placement_test
