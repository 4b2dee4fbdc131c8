// Tests the time in a file: it is never an axis of a volume, and it is kept if it is known.
#include <tuple>

#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_time_test {
namespace {

class Hdf5Time : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy, netCDF4")) GTEST_SKIP() << "python3 with h5py and netCDF4 is missing";
  }
  FieldDetails details_of(const std::string& file, const std::string& dataset, std::vector<std::int64_t> index = {}) {
    return open_source(scratch_.path(file), dataset_options(dataset, std::move(index)))->info().details;
  }

  Scratch scratch_;
};

// Writes a file like those of the cloud model CM1.
constexpr const char* kCm1 = R"(
import netCDF4
n = netCDF4.Dataset("cm1out.nc", "w")
for name, size in [("time", None), ("zh", 5), ("yh", 7), ("xh", 9)]: n.createDimension(name, size)
def coordinate(name, values, units):
    c = n.createVariable(name, "f4", (name,)); c[:] = values; c.units = units
coordinate("time", [0, 600, 1200], "seconds since 2000-01-01 00:00:00")
coordinate("zh", [0.1, 0.3, 0.6, 1.0, 1.5], "km")
coordinate("yh", np.arange(7) * 0.5, "km")
coordinate("xh", np.arange(9) * 0.5, "km")
for name in ["prs", "qc"]:
    v = n.createVariable(name, "f4", ("time", "zh", "yh", "xh")); v[:] = values("f4", (3,) + SHAPE)
    v.long_name = "cloud water"; v.units = "kg/kg"
expect("qc2", n["qc"][2])
r = n.createVariable("rain", "f4", ("time", "yh", "xh")); r[:] = values("f4", (3, 7, 9))
expect("rain", r[:])
n.close()
)";

TEST_F(Hdf5Time, PlanesOverTimeAreNoVolume) {
  write_by_h5py(scratch_, kCm1);
  const std::string rain = "2 axes and time (time=3 x yh=7 x xh=9); a volume has three axes of space";
  const std::vector<DatasetInfo> listed = list_hdf5(scratch_.path("cm1out.nc"), {});
  const auto found = std::find_if(listed.begin(), listed.end(), [](const auto& d) { return d.name == "/rain"; });
  ASSERT_NE(found, listed.end());
  EXPECT_EQ(found->obstacle, rain);
  for (const auto& [name, value] : found->attributes) EXPECT_EQ(name.find("spacing"), std::string::npos) << value;
  EXPECT_EQ(
      message_of_error(ErrorKind::input, [&] { open_source(scratch_.path("cm1out.nc"), dataset_options("rain")); }),
      scratch_.path("cm1out.nc") + ": /rain: " + rain + "; to take the time for a length, give --spacing");
  SourceOptions as_length = dataset_options("rain");
  as_length.spacing = {0.5, 0.5, 1.0};
  expect_reads(scratch_, "cm1out.nc", as_length, "rain");
}

TEST_F(Hdf5Time, SeveralFieldsOfEachTimeAreAnErrorWithTheCommands) {
  write_by_h5py(scratch_, kCm1);
  const std::string path = scratch_.path("cm1out.nc");
  const std::string axes = " (time=3 x zh=5 x yh=7 x xh=9)";
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, {}); }),
            path + ": holds 2 volumes; choose one with --dataset: weir convert " + path + " --dataset /prs --index 0" +
                axes + "; weir convert " + path + " --dataset /qc --index 0" + axes);
  expect_reads(scratch_, "cm1out.nc", dataset_options("/qc", {2}), "qc2");
}

TEST_F(Hdf5Time, TimeUnitsLongNameAndIrregularAxisAreKept) {
  write_by_h5py(scratch_, kCm1);
  const FieldDetails details = details_of("cm1out.nc", "qc", {2});
  EXPECT_EQ(details.long_name, "cloud water");
  ASSERT_TRUE(details.time.has_value());
  EXPECT_EQ(details.time->value, 1200);
  EXPECT_EQ(details.time->units, "seconds since 2000-01-01 00:00:00");
  EXPECT_EQ(details.axes[0].units, "km");
  EXPECT_TRUE(details.axes[0].coordinates.empty());
  EXPECT_EQ(details.axes[0].note, "");
  ASSERT_EQ(details.axes[2].coordinates.size(), 5U);
  EXPECT_NEAR(details.axes[2].coordinates[3], 1.0, 1e-6);
  EXPECT_EQ(details.axes[2].note, "irregular coordinates from 0.1 to 1.5, taken as indices");
}

TEST_F(Hdf5Time, SpacingOnTheCommandLineSettlesAnIrregularAxis) {
  write_by_h5py(scratch_, kCm1);
  SourceOptions options = dataset_options("qc", {0});
  options.spacing = {1, 1, 1};
  EXPECT_EQ(open_source(scratch_.path("cm1out.nc"), options)->info().details.axes[2].note, "");
}

TEST_F(Hdf5Time, AuxiliaryCoordinateAndOpenPmdIterationGiveTheTime) {
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("wrf.nc", "w")
for name, size in [("Time", 2), ("z", 5), ("y", 7), ("x", 9)]: n.createDimension(name, size)
t = n.createVariable("XTIME", "f4", ("Time",)); t[:] = [180, 360]; t.units = "minutes since 2005-08-28 00:00:00"
v = n.createVariable("QCLOUD", "f4", ("Time", "z", "y", "x")); v[:] = values("f4", (2,) + SHAPE); v.coordinates = "XLONG XLAT XTIME"
n.close()
with h5py.File("pmd.h5", "w") as f:
    f["data/100/meshes/rho"] = values("f4")
    f["data/100"].attrs.update({"time": 5.0, "timeUnitSI": 1e-15})
)");
  const auto wrf = details_of("wrf.nc", "QCLOUD", {1}).time;
  ASSERT_TRUE(wrf.has_value());
  EXPECT_EQ(wrf->value, 360);
  EXPECT_EQ(wrf->units, "minutes since 2005-08-28 00:00:00");
  const auto pmd = details_of("pmd.h5", "/data/100/meshes/rho").time;
  ASSERT_TRUE(pmd.has_value());
  EXPECT_EQ(pmd->value, 5.0 * 1e-15);
  EXPECT_EQ(pmd->units, "s");
}

// The dimensions `time` and `step` have three records each. `flux` has two records in the file, and `late` one; an
// auxiliary coordinate has the times of `late`.
constexpr const char* kShorter = R"(
import netCDF4
n = netCDF4.Dataset("a.nc", "w")
for name, size in [("time", None), ("step", None), ("z", 5), ("y", 7), ("x", 9)]: n.createDimension(name, size)
t = n.createVariable("time", "f8", ("time",)); t[:] = [0, 6, 12]; t.units = "hours since 2000-01-01"
w = n.createVariable("when", "f8", ("step",)); w[:] = [1, 2, 3]; w.units = "days since 2000-01-01"
full, flux = (n.createVariable(name, "f4", ("time", "z", "y", "x")) for name in ["full", "flux"])
late = n.createVariable("late", "f4", ("step", "z", "y", "x")); late.coordinates = "when"
full[:] = values("f4", (3,) + SHAPE); flux[:2] = values("f4", (2,) + SHAPE); late[:1] = values("f4", (1,) + SHAPE)
expect("flux1", flux[1])
assert flux.shape[0] == 3 and late.shape[0] == 3
n.close()
)";

TEST_F(Hdf5Time, VariableOfFewerRecordsThanItsDimension_KeepsItsTimesAndSaysSo) {
  write_by_h5py(scratch_, kShorter);
  expect_reads(scratch_, "a.nc", dataset_options("flux", {1}), "flux1");
  const FieldDetails details = details_of("a.nc", "flux", {1});
  ASSERT_TRUE(details.time.has_value());
  EXPECT_EQ(details.time->value, 6);
  EXPECT_EQ(details.time->units, "hours since 2000-01-01");
  EXPECT_EQ(details.values_note,
            "its dimension time has 3 elements, of which 2 are written here: positions count these, and the last one "
            "is 1");
  EXPECT_EQ(details_of("a.nc", "full", {2}).values_note, "");
  EXPECT_EQ(details_of("a.nc", "full", {2}).time->value, 12);
}

TEST_F(Hdf5Time, AuxiliaryTimesOfMoreRecords_AreThoseOfTheFirst) {
  write_by_h5py(scratch_, kShorter);
  const FieldDetails details = details_of("a.nc", "late", {0});
  ASSERT_TRUE(details.time.has_value());
  EXPECT_EQ(details.time->value, 1);
  EXPECT_EQ(details.values_note,
            "its dimension step has 3 elements, of which 1 is written here: positions count these, and the last one is "
            "0");
}

TEST_F(Hdf5Time, PositionOfARecordThatWasNotWritten_IsRefused) {
  write_by_h5py(scratch_, kShorter);
  const std::string path = scratch_.path("a.nc");
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, dataset_options("flux", {2})); }),
            path +
                ": /flux: its axes are time=2 x z=5 x y=7 x x=9, and --index has 2; give --index with 1 position: "
                "time in 0..1 (2 was not written)");
  SourceOptions named = dataset_options("flux");
  named.index_choices = {{"time", false, 2, {}}};
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, named); }),
            path +
                ": /flux: --index has 2, and time has the positions 0 to 1 (2 was not written), or from the end -2 "
                "to -1");
}

// openPMD 1.1, "Required for each Record": timeOffset has the same unit as the time of the iteration.
TEST_F(Hdf5Time, OffsetOfAnOpenPmdRecord_IsAddedToTheTime) {
  write_by_h5py(scratch_, R"(
with h5py.File("pmd.h5", "w") as f:
    f["data/100/fields/rho"] = values("f4")
    f["data/100/fields/rho"].attrs["timeOffset"] = np.float32(0.25)
    f["data/100/fields/B/x"] = values("f4")
    f["data/100/fields/B"].attrs["timeOffset"] = -0.5
    f["data/100/fields/E/x"] = values("f4")
    f["data/100"].attrs.update({"time": 5.0, "timeUnitSI": 1e-15})
)");
  for (const auto& [name, time] : {std::pair("rho", 5.25), std::pair("B/x", 4.5), std::pair("E/x", 5.0)}) {
    const auto found = details_of("pmd.h5", cat("/data/100/fields/", name)).time;
    ASSERT_TRUE(found.has_value()) << name;
    EXPECT_EQ(found->value, time * 1e-15) << name;
  }
}

TEST_F(Hdf5Time, AuxiliaryCoordinateOfSeveralAxes_IsNoTime) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = values("f4"); f["v"].attrs["coordinates"] = "when"
    f["when"] = np.zeros((2, 2)); f["when"].attrs["units"] = "days since 2000-01-01"
)");
  EXPECT_FALSE(details_of("a.h5", "v").time.has_value());
}

TEST_F(Hdf5Time, SpacingOfVoxels_IsNoTime) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = values("f4", (5, 3, 7, 9)); f["v"].attrs["spacing"] = [0.5, 0.5, 0.5]
    for axis, name in enumerate(["z", "time", "y", "x"]): f["v"].dims[axis].label = name
)");
  EXPECT_FALSE(details_of("a.h5", "v", {2}).time.has_value());
}

TEST_F(Hdf5Time, TimeBetweenTheAxesOfSpaceIsChosenByIndex) {
  write_by_h5py(scratch_, R"(
v = values("f4", (3,) + SHAPE)
expect("v1", v[1])
w = values("i2", (3,) + SHAPE + (2,))
expect("w2y", w[2, ..., 1])
def label(d, names):
    for axis, name in enumerate(names): d.dims[axis].label = name
with h5py.File("a.h5", "w") as f:
    second, last = np.moveaxis(v, 0, 1), np.moveaxis(v, 0, 3)
    label(f.create_dataset("second", data=second), ["z", "time", "y", "x"])
    label(f.create_dataset("big", data=second.astype(">f4")), ["z", "time", "y", "x"])
    label(f.create_dataset("gzip", data=second, chunks=(2, 2, 3, 4), compression="gzip"), ["z", "time", "y", "x"])
    label(f.create_dataset("last", data=last, chunks=(2, 3, 4, 3), compression="gzip", shuffle=True), ["z", "y", "x", "time"])
    label(f.create_dataset("pairs", data=last, chunks=(2, 3, 4, 2), compression="gzip"), ["z", "y", "x", "time"])
    label(f.create_dataset("szip", data=last, chunks=(2, 3, 4, 2), compression="szip"), ["z", "y", "x", "time"])
    label(f.create_dataset("vectors", data=np.moveaxis(w, 0, 1)), ["z", "time", "y", "x", "component"])
    outside = f.create_dataset("outside", second.shape, "f4", external="values"); outside[:] = second
    label(outside, ["z", "time", "y", "x"])
)");
  for (const char* name : {"second", "big", "gzip", "last", "pairs", "szip"}) {
    expect_reads(scratch_, "a.h5", dataset_options(name, {1}), "v1");
    SourceOptions named = dataset_options(name);
    named.index_choices = {{"time", false, 1, {}}};
    expect_reads(scratch_, "a.h5", named, "v1");
  }
  SourceOptions component = dataset_options("vectors", {2});
  component.component = ComponentChoice{false, 1};
  expect_reads(scratch_, "a.h5", component, "w2y");
  EXPECT_EQ(
      message_of_error(ErrorKind::input, [&] { open_source(scratch_.path("a.h5"), dataset_options("outside", {1})); }),
      scratch_.path("a.h5") +
          ": /outside: its axes are z=5 x time=3 x y=7 x x=9, the time not before those of space, and its values "
          "lie in other files; write it with the time first, or into one file");
}

// The stored bytes of these chunks are those of their values.
TEST_F(Hdf5Time, TimeAfterTheAxesOfSpace_OnlyItsChunksAreRead) {
  write_by_h5py(scratch_, R"(
v = values("f4", (2,) + SHAPE + (5,))
expect("v", v[1, ..., 3])
with h5py.File("a.h5", "w") as f:
    for name, times in (("one", 1), ("two", 2)):
        d = f.create_dataset(name, data=v, chunks=(1,) + SHAPE + (times,))
        for axis, name in enumerate(["run", "z", "y", "x", "time"]): d.dims[axis].label = name
)");
  constexpr std::uint64_t kOfOneTime = std::uint64_t{4} * 5 * 7 * 9;
  for (const auto& [name, times] : {std::pair("one", 1U), std::pair("two", 2U)}) {
    expect_reads(scratch_, "a.h5", dataset_options(name, {1, 3}), "v");
    const auto source = open_source(scratch_.path("a.h5"), dataset_options(name, {1, 3}));
    all_values(*source);
    EXPECT_EQ(source->bytes_read(), times * kOfOneTime) << name;
  }
}

// The unlimited dimension `cycle` has no unit. `time` is in microseconds, which is not the shortest name in UDUNITS.
TEST_F(Hdf5Time, TimeInAnyUnitButOneOfSpace_IsNoAxisOfAVolume) {
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("a.nc", "w")
for name, size in [("cycle", None), ("time", 3), ("z", 5), ("y", 7), ("x", 9)]: n.createDimension(name, size)
for name, values_, units in [("cycle", [100, 200, 300], "1"), ("time", [1, 3, 5], "microseconds")]:
    c = n.createVariable(name, "f8", (name,)); c[:] = values_; c.units = units
for name in ["cycle", "time"]:
    n.createVariable(name + "_plane", "f4", (name, "y", "x"))[:] = values("f4", (3, 7, 9))
    v = n.createVariable(name + "_volume", "f4", (name, "z", "y", "x")); v[:] = values("f4", (3,) + SHAPE)
    expect(name, v[2])
n.close()
)");
  for (const auto& [name, value, units] : {std::tuple("cycle", 300.0, "1"), std::tuple("time", 5.0, "microseconds")}) {
    const std::string plane = cat(name, "_plane");
    EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(scratch_.path("a.nc"), dataset_options(plane)); }),
              cat(scratch_.path("a.nc"), ": /", plane, ": 2 axes and time (", name,
                  "=3 x y=7 x x=9); a volume has three axes of space; to take the time for a length, give --spacing"));
    const std::string volume = cat(name, "_volume");
    expect_reads(scratch_, "a.nc", dataset_options(volume, {2}), name);
    const auto time = details_of("a.nc", volume, {2}).time;
    ASSERT_TRUE(time.has_value()) << name;
    EXPECT_EQ(time->value, value);
    EXPECT_EQ(time->units, units);
  }
}

TEST_F(Hdf5Time, VolumeThatGrowsAlongAHeightIsAVolume) {
  write_by_h5py(scratch_, R"(
import netCDF4
n = netCDF4.Dataset("a.nc", "w")
for name, size in [("height", None), ("y", 7), ("x", 9)]: n.createDimension(name, size)
h = n.createVariable("height", "f4", ("height",)); h[:] = np.arange(5); h.units = "m"
v = n.createVariable("v", "f4", ("height", "y", "x")); v[:] = values("f4"); expect("v", v[:])
n.close()
n = netCDF4.Dataset("bare.nc", "w")
for name, size in [("level", None), ("y", 7), ("x", 9)]: n.createDimension(name, size)
n.createVariable("v", "f4", ("level", "y", "x"))[:] = np.fromfile("v.expected", "<f4").reshape(SHAPE)
n.close()
with h5py.File("grown.h5", "w") as f: f.create_dataset("v", data=np.fromfile("v.expected", "<f4").reshape(SHAPE), maxshape=(None, 7, 9))
)");
  expect_reads(scratch_, "a.nc", dataset_options("v"), "v");
  expect_reads(scratch_, "bare.nc", dataset_options("v"), "v");
  expect_reads(scratch_, "grown.h5", dataset_options("v"), "v");
}

}  // namespace
}  // namespace weir::hdf5_time_test
