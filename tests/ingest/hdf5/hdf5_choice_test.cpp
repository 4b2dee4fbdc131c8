// Tests how the volume of an HDF5 file is chosen, and the messages if none is chosen.
#include "ingest/hdf5/hdf5_source.h"

#include <filesystem>

#include "ingest/hdf5/file/hdf5_lock.h"
#include "ingest/series.h"
#include "ingest/series_names.h"
#include "tests/ingest/hdf5/support/h5py_file.h"
#include "tests/support/sanitized.h"

namespace weir::hdf5_choice_test {
namespace {

class Hdf5Choice : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }
  std::string refused(const std::string& file, const SourceOptions& options, ErrorKind kind = ErrorKind::input) {
    std::string message = message_of_error(kind, [&] { open_source(scratch_.path(file), options); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }

  Scratch scratch_;
};

TEST_F(Hdf5Choice, TakesLeadingAxesByIndex) {
  write_by_h5py(scratch_, R"(
v = values("i4", (3, 2) + SHAPE)
for i in range(3):
    for j in range(2): expect("%d%d" % (i, j), v[i, j])
with h5py.File("a.h5", "w") as f:
    f["plain"] = v
    f.create_dataset("packed", data=v, chunks=(2, 1, 3, 3, 3), compression="gzip")
    f.create_dataset("szip", data=v, chunks=(2, 2, 3, 7, 3), compression="szip")
    f["ones"] = v[1:2, 1:2]
    f.create_dataset("later", data=v[0], maxshape=(None,) + SHAPE)
)");
  for (const char* name : {"plain", "packed", "szip"}) {
    for (const std::int64_t i : {0, 1, 2}) {
      for (const std::int64_t j : {0, 1}) {
        expect_reads(scratch_, "a.h5", dataset_options(name, {i, j}), std::to_string(i) + std::to_string(j));
      }
    }
  }
  expect_reads(scratch_, "a.h5", dataset_options("ones"), "11");
  expect_reads(scratch_, "a.h5", dataset_options("ones", {0, 0}), "11");
  expect_reads(scratch_, "a.h5", dataset_options("later", {1}), "01");
  const std::string where = scratch_.path("a.h5") + ": /plain: its axes are 3 x 2 x 5 x 7 x 9";
  const std::string remedy = "; give --index with 2 positions: axis 0 in 0..2, axis 1 in 0..1";
  EXPECT_EQ(refused("a.h5", dataset_options("plain"), ErrorKind::usage), where + ", and a volume has three" + remedy);
  EXPECT_EQ(refused("a.h5", dataset_options("plain", {1}), ErrorKind::usage),
            where + ", and --index has 1 position" + remedy);
  EXPECT_EQ(refused("a.h5", dataset_options("plain", {1, 2}), ErrorKind::usage),
            where + ", and --index has 2" + remedy);
  EXPECT_EQ(refused("a.h5", dataset_options("plain", {-1, 0}), ErrorKind::usage),
            where + ", and --index has -1" + remedy);
}

TEST_F(Hdf5Choice, OnlyVolumeIsTheDefault) {
  write_by_h5py(scratch_, R"(
v = values("f4"); expect("v", v)
with h5py.File("one.h5", "w") as f:
    f["time"] = 1.0
    f["lat"] = np.zeros((3, 4))
    f["deep/er/v"] = v
with h5py.File("steps.h5", "w") as f:
    f["v"] = v
    f["steps"] = np.stack([v, v])
with h5py.File("two.h5", "w") as f:
    f["a"] = v
    f["b"] = v
with h5py.File("none.h5", "w") as f:
    f["time"] = 1.0
    f["lat"] = np.zeros((3, 4))
with h5py.File("flat.h5", "w") as f: f["lat"] = np.zeros((3, 4))
with h5py.File("empty.h5", "w") as f: f.create_group("g")
)");
  expect_reads(scratch_, "one.h5", {}, "v");
  expect_reads(scratch_, "steps.h5", dataset_options("", {1}), "v");
  const auto command = [&](const std::string& file) { return "weir convert " + scratch_.path(file) + " --dataset "; };
  EXPECT_EQ(refused("two.h5", {}, ErrorKind::usage),
            scratch_.path("two.h5") + ": holds 2 volumes; choose one with --dataset: " + command("two.h5") +
                "/a (5 x 7 x 9); " + command("two.h5") + "/b (5 x 7 x 9)");
  EXPECT_EQ(refused("steps.h5", {}, ErrorKind::usage),
            scratch_.path("steps.h5") + ": holds 2 volumes; choose one with --dataset: " + command("steps.h5") +
                "/steps --index 0 (2 x 5 x 7 x 9); " + command("steps.h5") + "/v (5 x 7 x 9)");
  EXPECT_EQ(refused("none.h5", {}), scratch_.path("none.h5") +
                                        ": none of its 2 datasets is a volume; the nearest is /lat: 2 axes (3 x 4); a "
                                        "volume has three; weir inspect lists them");
  EXPECT_EQ(refused("flat.h5", {}), scratch_.path("flat.h5") + ": /lat: 2 axes (3 x 4); a volume has three");
  EXPECT_EQ(refused("empty.h5", {}), scratch_.path("empty.h5") + ": holds no dataset; name a file that has one");
}

// Coordinates and planes over time are no volumes, so the notice does not name them.
TEST_F(Hdf5Choice, VolumesThatCannotBeRead_AreNamedBesideTheOneThatIsTaken) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = np.zeros((2, 3, 4), "f4")
    for name in ["c1", "c2", "c3", "c4"]: f[name] = np.zeros((2, 3, 4), "c8")
    f["lat"] = np.zeros((3, 4), "c8")
    f["rain"] = np.zeros((2, 3, 4), "f4"); f["rain"].dims[0].label = "time"
with h5py.File("alone.h5", "w") as f:
    f["v"] = np.zeros((2, 3, 4), "f4")
    f["lat"] = np.zeros((3, 4), "c8")
)");
  std::vector<std::string> said;
  SourceOptions options;
  options.notice = [&](const Message& line) { said.push_back(line.text()); };
  EXPECT_EQ(open_source(scratch_.path("a.h5"), options)->info().dataset, "/v");
  const std::string why =
      ": its type is compound of 2 members; a volume has integers of 8 to 64 bits or floats of 16, 32 or 64";
  EXPECT_EQ(said, (std::vector<std::string>{scratch_.path("a.h5") + ": /v is read; left out: /c1" + why + "; /c2" +
                                            why + "; /c3" + why + "; and 1 more (weir inspect lists them)"}));
  said.clear();
  options.dataset = "v";
  open_source(scratch_.path("a.h5"), options);
  options.dataset.clear();
  open_source(scratch_.path("alone.h5"), options);
  EXPECT_EQ(said, std::vector<std::string>{}) << "where it is named, or there is no other";
}

TEST_F(Hdf5Choice, MissingDatasetErrorSuggestsOtherNames) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name in ["fields/density", "fields/Temperature", "v"]: f[name] = np.zeros((2, 2, 2))
    f.create_group("bare")
    f["type"] = np.dtype("f4")
)");
  const std::string path = scratch_.path("a.h5");
  EXPECT_EQ(refused("a.h5", dataset_options("fields/desnity")),
            path + ": no dataset /fields/desnity; did you mean /fields/density? weir inspect lists all");
  EXPECT_EQ(refused("a.h5", dataset_options("/temperature")),
            path + ": no dataset /temperature; did you mean /fields/Temperature? weir inspect lists all");
  EXPECT_EQ(refused("a.h5", dataset_options("/x/y/z")),
            path + ": no dataset /x/y/z; the file holds /v, /fields/Temperature, /fields/density");
  EXPECT_EQ(refused("a.h5", dataset_options("fields/")),
            path + ": /fields is a group; give one of its datasets: /fields/Temperature, /fields/density");
  EXPECT_EQ(refused("a.h5", dataset_options("/bare")), path + ": /bare is a group, and holds no dataset");
  EXPECT_EQ(refused("a.h5", dataset_options("v/w")),
            path + ": no dataset /v/w; the file holds /v, /fields/Temperature, /fields/density");
  EXPECT_EQ(refused("a.h5", dataset_options("type")), path + ": /type: a named type, no dataset");
}

TEST_F(Hdf5Choice, DatasetPatterns_AreTheVolumesTheyMatch) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name in ["fields/rho", "fields/T", "grid"]: f[name] = np.zeros((2, 3, 4), "f4")
    f["times"] = np.zeros(4)
    f["series"] = np.zeros((5, 2, 3, 4), "f4")
)");
  const auto datasets = [&](const std::string& dataset, std::vector<AxisChoice> choices = {}) {
    SourceOptions options = dataset_options(dataset);
    options.index_choices = std::move(choices);
    std::string names;
    for (const SeriesStep& step : expand_series(std::vector{scratch_.path("a.h5")}, options))
      names += step.dataset + ' ';
    return names;
  };
  EXPECT_EQ(datasets("*"), "/grid /fields/T /fields/rho ") << "what is no volume without --index is left out";
  EXPECT_EQ(datasets("fields/*"), "/fields/T /fields/rho ");
  EXPECT_EQ(datasets("/fields/[r]*"), "/fields/rho ");
  EXPECT_EQ(datasets("*", {{{}, false, -1, {}}}), "/series ");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { datasets("x*"); }),
            scratch_.path("a.h5") + ": no dataset's name matches x*; weir inspect lists what there is");
}

TEST_F(Hdf5Choice, DefaultNames_HaveThePositionsOfAnArrayOfComponents) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f: f["v"] = np.zeros((12, 5, 6, 3), "f4")
)");
  const auto name = [&](const SourceOptions& options) {
    const auto steps = expand_series(std::vector{scratch_.path("a.h5")}, options);
    return std::filesystem::path(series_outputs(steps, "out/", options).front()).filename().string();
  };
  SourceOptions options;
  options.index = {7};
  EXPECT_EQ(name(options), "a_07.nvdb");
  EXPECT_EQ(open_source(scratch_.path("a.h5"), options)->info().extent, (Index3{3, 6, 5}));
  options.index.clear();
  options.component = ComponentChoice{false, 1};
  EXPECT_EQ(name(options), "a_y.nvdb");
}

TEST_F(Hdf5Choice, IndexByName_BelowZeroAndRanges) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    v = f.create_dataset("v", data=np.arange(4 * 3 * 24, dtype="f4").reshape(4, 3, 2, 3, 4))
    for axis, name in enumerate(["time", "level"]): v.dims[axis].label = name
    for axis, (name, n) in enumerate([("time", 4), ("level", 3)]):
        f[name] = np.arange(n, dtype="f8"); f[name].make_scale(name); v.dims[axis].attach_scale(f[name])
)");
  const auto first_value = [&](std::vector<AxisChoice> choices) {
    SourceOptions options = dataset_options("v");
    options.index_choices = std::move(choices);
    return all_values(*open_source(scratch_.path("a.h5"), options)).front();
  };
  EXPECT_EQ(first_value({{{}, false, -1, {}}, {{}, false, 0, {}}}), 3 * 3 * 24);
  EXPECT_EQ(first_value({{"level", false, 2, {}}, {"time", false, 1, {}}}), 1 * 3 * 24 + 2 * 24);
  EXPECT_EQ(message_of_error(ErrorKind::usage,
                             [&] {
                               first_value({{"depth", false, 2, {}}});
                             }),
            scratch_.path("a.h5") + ": --index: no axis depth; /v has time, level");
  EXPECT_EQ(message_of_error(ErrorKind::usage,
                             [&] {
                               first_value({{{}, false, -1, {}}});
                             }),
            scratch_.path("a.h5") +
                ": --index has 1 position, and /v has time of 4, level of 3; weir inspect lists what there is");
}

TEST_F(Hdf5Choice, RefusesDatasetsThatAreNoNumericVolume) {
  write_by_h5py(scratch_, R"(
S = (2, 2, 2)
with h5py.File("a.h5", "w") as f:
    f["compound"] = np.zeros(S, [("a", "f4"), ("b", "i4")])
    f["complex"] = np.zeros(S, "c8")
    f["text"] = np.zeros(S, "S5")
    f.create_dataset("vtext", S, dtype=h5py.string_dtype())
    f.create_dataset("ref", S, dtype=h5py.ref_dtype)
    f["opaque"] = np.zeros(S, "V3")
    f["long double"] = np.zeros(S, "g")
    f.create_dataset("array", S, dtype=np.dtype(("f4", (3,))))
    f.create_dataset("list", S, dtype=h5py.vlen_dtype("f4"))
    def odd(name, type): h5py.h5d.create(f.id, name, type, h5py.h5s.create_simple(S)).write(h5py.h5s.ALL, h5py.h5s.ALL, np.zeros(S, "i4"), type)
    t = h5py.h5t.STD_I32LE.copy(); t.set_precision(20); odd(b"i20", t)
    odd(b"bits", h5py.h5t.STD_B16LE)
    t = h5py.h5t.IEEE_F32LE.copy(); t.set_fields(15, 7, 8, 0, 7); t.set_size(2); t.set_ebias(127); odd(b"bfloat16", t)
    f["scalar"] = 1.0
    f["line"] = np.zeros(4)
    f.create_dataset("null", dtype="f4", data=h5py.Empty("f4"))
    f.create_dataset("empty", (0, 3, 4), maxshape=(None, 3, 4))
    f.create_dataset("unwritten", S)
    f.create_dataset("unwritten chunks", S, chunks=S)
)");
  const auto said = [&](const std::string& name) {
    const std::string start = scratch_.path("a.h5") + ": /" + name + ": ";
    const std::string message = refused("a.h5", dataset_options(name));
    EXPECT_TRUE(message.starts_with(start)) << message;
    return message.substr(std::min(start.size(), message.size()));
  };
  const auto typed = [](const std::string& type) {
    return "its type is " + type + "; a volume has integers of 8 to 64 bits or floats of 16, 32 or 64";
  };
  EXPECT_EQ(said("compound"), typed("compound of 2 members"));
  EXPECT_EQ(said("complex"), typed("compound of 2 members"));
  EXPECT_EQ(said("text"), typed("text of 5 bytes"));
  EXPECT_EQ(said("vtext"), typed("text of any length"));
  EXPECT_EQ(said("ref"), typed("reference"));
  EXPECT_EQ(said("opaque"), typed("opaque of 3 bytes"));
  EXPECT_EQ(said("long double"), typed("float of 80 bits in 16 bytes"));
  EXPECT_EQ(said("array"), typed("array of float32"));
  EXPECT_EQ(said("list"), typed("list of any length"));
  EXPECT_EQ(said("i20"),
            "its type is integer of 20 bits in 4 bytes; an integer's precision must be 8, 16, 32 or 64 bits, all that "
            "its bytes hold");
  EXPECT_EQ(said("bits"), typed("bit field of 16 bits in 2 bytes"));
  EXPECT_EQ(said("bfloat16"), typed("float of 16 bits in 2 bytes, not IEEE 754"));
  EXPECT_EQ(said("scalar"), "a single value; a volume has three axes");
  EXPECT_EQ(said("line"), "1 axis (4); a volume has three");
  EXPECT_EQ(said("null"), "a single value; a volume has three axes");
  EXPECT_EQ(said("empty"), "empty: 0 x 3 x 4");
  EXPECT_EQ(said("unwritten"), "no value was ever written to it; convert it when its values are there");
  EXPECT_EQ(said("unwritten chunks"), "no value was ever written to it; convert it when its values are there");
}

}  // namespace
}  // namespace weir::hdf5_choice_test
