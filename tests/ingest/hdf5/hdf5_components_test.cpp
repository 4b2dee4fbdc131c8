// Tests which component of an array of vectors or tensors is read, for every kind of storage.
#include "format/base/text.h"
#include "ingest/hdf5/hdf5_source.h"
#include "ingest/series.h"
#include "ingest/series_names.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_components_test {
namespace {

SourceOptions options_for(const std::string& dataset, const ComponentChoice& component,
                          std::vector<std::int64_t> index = {}) {
  SourceOptions options = dataset_options(dataset, std::move(index));
  options.component = component;
  return options;
}

class Hdf5Components : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }

  Scratch scratch_;
};

TEST_F(Hdf5Components, EveryStorageGivesTheSameComponentsAndMagnitude) {
  write_by_h5py(scratch_, R"(
v = values("f4", SHAPE + (3,))
for c in range(3): expect("c%d" % c, v[..., c])
expect("m", np.sqrt((v.astype("f8") ** 2)[..., 0] + (v.astype("f8") ** 2)[..., 1] + (v.astype("f8") ** 2)[..., 2]))
raw = v.astype("<f4").tobytes()
open("outside", "wb").write(raw)
open("part1", "wb").write(raw[:700]); open("part2", "wb").write(raw[700:])
with h5py.File("a.h5", "w") as f:
    f["contiguous"] = v
    f.create_dataset("big", data=v.astype(">f4"))
    f.create_dataset("gzip", data=v, chunks=(2, 3, 4, 3), compression="gzip", shuffle=True)
    f.create_dataset("planes", data=v, chunks=(1, 7, 9, 3), compression="gzip")
    f.create_dataset("separate", data=v, chunks=(5, 7, 9, 1), compression="gzip")
    f.create_dataset("pairs", data=v, chunks=(2, 3, 4, 2), compression="gzip", shuffle=True)
    f.create_dataset("plain_pairs", data=v, chunks=(2, 3, 4, 2))
    f.create_dataset("five", data=v, chunks=(2, 3, 4, 5), maxshape=SHAPE + (None,), compression="gzip")
    f.create_dataset("szip", data=v, chunks=(2, 7, 9, 3), compression="szip")
    f.create_dataset("szip_pairs", data=v, chunks=(2, 7, 9, 2), compression="szip")
    f.create_dataset("szip_separate", data=v, chunks=(2, 7, 8, 1), compression="szip")
    f.create_dataset("external", SHAPE + (3,), "f4", external="outside")
    f.create_dataset("spread", SHAPE + (3,), "f4", external=[("part1", 0, 700), ("part2", 0, h5py.h5f.UNLIMITED)])
    layout = h5py.VirtualLayout(SHAPE + (3,), "f4")
    for z in range(5): layout[z] = h5py.VirtualSource("a.h5", "gzip", SHAPE + (3,))[z]
    f.create_virtual_dataset("virtual", layout)
)");
  for (const char* name : {"contiguous", "big", "gzip", "planes", "separate", "pairs", "plain_pairs", "five", "szip",
                           "szip_pairs", "szip_separate", "external", "spread", "virtual"}) {
    for (const std::int64_t c : {0, 1, 2}) {
      expect_reads(scratch_, "a.h5", options_for(name, {false, c}), "c" + std::to_string(c));
    }
    expect_reads(scratch_, "a.h5", options_for(name, {true, 0}), "m");
  }
}

// The stored bytes of these chunks are those of their values.
TEST_F(Hdf5Components, OnlyChunksOfTheComponentAreRead) {
  write_by_h5py(scratch_, R"(
v = np.zeros((16, 16, 16, 3), "f4")
with h5py.File("a.h5", "w") as f:
    f.create_dataset("separate", data=v, chunks=(8, 8, 8, 1))
    f.create_dataset("pairs", data=v, chunks=(8, 8, 8, 2))
    f.create_dataset("szip", data=v, chunks=(8, 8, 8, 1), compression="szip")
)");
  const auto bytes_read = [&](const std::string& dataset, const ComponentChoice& component) {
    const auto source = open_source(scratch_.path("a.h5"), options_for(dataset, component));
    all_values(*source);
    return source->bytes_read();
  };
  constexpr std::uint64_t kOfOne = std::uint64_t{4} * 16 * 16 * 16;
  for (const std::int64_t c : {0, 1, 2}) {
    EXPECT_EQ(bytes_read("separate", {false, c}), kOfOne) << c;
    EXPECT_EQ(bytes_read("pairs", {false, c}), 2 * kOfOne) << c;
    EXPECT_EQ(bytes_read("szip", {false, c}), kOfOne) << c;
  }
  EXPECT_EQ(bytes_read("separate", {true, 0}), 3 * kOfOne);
  EXPECT_EQ(bytes_read("pairs", {true, 0}), 4 * kOfOne) << "the second chunk has a number that no voxel has";
}

TEST_F(Hdf5Components, UnwrittenChunksOfOneComponent_ReadAsTheFillValue) {
  write_by_h5py(scratch_, R"(
v = values("f4", SHAPE + (3,)); v[:, :3, 4:8, 2] = -2.5; v[4:, 6:, :4, :] = -2.5
for c in range(3): expect("c%d" % c, v[..., c])
w = v.astype("f8"); expect("m", np.sqrt(w[..., 0] ** 2 + w[..., 1] ** 2 + w[..., 2] ** 2))
with h5py.File("a.h5", "w") as f:
    for name, unit in (("separate", 1), ("pairs", 2)):
        d = f.create_dataset(name, SHAPE + (3,), "f4", chunks=(2, 3, 4, unit), compression="gzip", fillvalue=-2.5)
        for at in np.ndindex(3, 3, 3, -(-3 // unit)):
            part = tuple(slice(i * n, i * n + n) for i, n in zip(at, (2, 3, 4, unit)))
            if not (v[part] == -2.5).all(): d[part] = v[part]
)");
  for (const char* name : {"separate", "pairs"}) {
    for (const std::int64_t c : {0, 1, 2}) {
      expect_reads(scratch_, "a.h5", options_for(name, {false, c}), "c" + std::to_string(c));
    }
    expect_reads(scratch_, "a.h5", options_for(name, {true, 0}), "m");
  }
  const auto note = [&](const ComponentChoice& component) {
    return open_source(scratch_.path("a.h5"), options_for("separate", component))->info().details.chunks_note;
  };
  EXPECT_EQ(note({false, 0}), "1 of its 27 chunks was never written and reads as its fill value, -2.5");
  EXPECT_EQ(note({false, 2}), "4 of its 27 chunks were never written and read as its fill value, -2.5");
}

TEST_F(Hdf5Components, ComponentsBeforeATime_AreRefused) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("v", data=values("f4", SHAPE + (3, 2)))
    for axis, name in enumerate(["z", "y", "x", "component", "time"]): d.dims[axis].label = name
)");
  const std::string expected = scratch_.path("a.h5") +
                               ": /v: its components come before its time (z=5 x y=7 x x=9 x component=3 x time=2); "
                               "write it with the components as the last axis";
  const auto refused = [&](const SourceOptions& options) {
    return message_of_error(ErrorKind::input, [&] { open_source(scratch_.path("a.h5"), options); });
  };
  EXPECT_EQ(refused(options_for("v", {false, 1}, {1})), expected);
  EXPECT_EQ(refused(dataset_options("v", {0, 0})), expected);
}

TEST_F(Hdf5Components, LeadingAxesAreChosenByIndexBesides) {
  write_by_h5py(scratch_, R"(
v = values("f8", (4,) + SHAPE + (2,))
expect("v", v[2, ..., 1])
expect("m", np.sqrt(v[2, ..., 0] ** 2 + v[2, ..., 1] ** 2))
with h5py.File("a.h5", "w") as f:
    f["contiguous"] = v
    f.create_dataset("gzip", data=v, chunks=(3, 2, 3, 4, 2), compression="gzip")
    f.create_dataset("separate", data=v, chunks=(3, 2, 3, 4, 1), compression="gzip")
    f.create_dataset("szip", data=v, chunks=(3, 2, 7, 9, 1), compression="szip")
)");
  for (const char* name : {"contiguous", "gzip", "separate", "szip"}) {
    expect_reads(scratch_, "a.h5", options_for(name, {false, 1}, {2}), "v");
    expect_reads(scratch_, "a.h5", options_for(name, {true, 0}, {2}), "m");
  }
}

TEST_F(Hdf5Components, LeadingAxisOfComponentsIsChosenFromToo) {
  write_by_h5py(scratch_, R"(
v = values("f4", (2, 3) + SHAPE)
expect("c", v[1, 2])
d = v[1].astype("f8")
expect("m", np.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]))
with h5py.File("a.h5", "w") as f:
    f["contiguous"] = v
    f.create_dataset("gzip", data=v, chunks=(1, 2, 2, 3, 4), compression="gzip")
    layout = h5py.VirtualLayout(v.shape, "f4")
    for c in range(3): layout[:, c] = h5py.VirtualSource("a.h5", "gzip", v.shape)[:, c]
    f.create_virtual_dataset("virtual", layout)
)");
  for (const char* name : {"contiguous", "gzip", "virtual"}) {
    expect_reads(scratch_, "a.h5", options_for(name, {false, 2}, {1}), "c");
    expect_reads(scratch_, "a.h5", options_for(name, {true, 0}, {1}), "m");
  }
}

TEST_F(Hdf5Components, UnwrittenChunksHaveTheFillValuesMagnitude) {
  write_by_h5py(scratch_, R"(
v = np.full(SHAPE + (4,), 3.0, "f4"); v[0] = 1.0
expect("m", np.sqrt((v.astype("f8") ** 2).sum(axis=3)))
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("v", SHAPE + (4,), "f4", chunks=(1, 7, 9, 4), fillvalue=3.0)
    d[0] = v[0]
)");
  expect_reads(scratch_, "a.h5", options_for("v", {true, 0}), "m");
}

TEST_F(Hdf5Components, ListingSaysHowSureItIs) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = values("f4", (10, 11, 12, 3))
    f["w"] = values("f4", (10, 11, 12, 6))
    f["w"].dims[3].label = "component"
    f["v"].attrs["spacing"] = [1.0, 2.0, 3.0]
)");
  const std::vector<DatasetInfo> listed = list_hdf5(scratch_.path("a.h5"), {});
  ASSERT_EQ(listed.size(), 2U);
  using Attributes = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(listed[0].components, 3);
  EXPECT_EQ(listed[0].leading_axes, 0U);
  EXPECT_EQ(listed[0].attributes,
            (Attributes{{"components", "3 along the last axis, by its extent alone"}, {"spacing x,y,z", "1,2,3"}}));
  EXPECT_EQ(listed[1].components, 6);
  EXPECT_EQ(listed[1].attributes, (Attributes{{"axes", "10 x 11 x 12 x component=6"},
                                              {"components", "6 along the last axis, by its name component"}}));
  const auto source = open_source(scratch_.path("a.h5"), options_for("v", {true, 0}));
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(source->info().details.component, "magnitude");
}

// --component decides along which axes --index chooses, for plain positions and for choices such as -1 and time=2.
TEST_F(Hdf5Components, IndexChoices_AreOfTheAxesThatPositionsAreOf) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = np.arange(12 * 5 * 6 * 3, dtype="f4").reshape(12, 5, 6, 3)
    w = f.create_dataset("w", data=np.arange(4 * 3 * 24, dtype="f4").reshape(4, 3, 2, 3, 4))
    for axis, name in enumerate(["time", "vector", "z", "y", "x"]): w.dims[axis].label = name
)");
  const auto steps = [&](SourceOptions options, const std::string& choices) {
    for (const std::string& choice : split(choices, ',')) options.index_choices.push_back(*parse_axis_choice(choice));
    std::string text;
    const auto expanded = expand_series(std::vector{scratch_.path("a.h5")}, options);
    const auto names = series_outputs(expanded, "out/", options);
    for (std::size_t i = 0; i < expanded.size(); ++i) {
      const auto source = open_source(expanded[i].path, options_of_step(options, expanded[i]));
      text += cat(text.empty() ? "" : " ", names[i].substr(4), ':', all_values(*source).front());
    }
    return text;
  };
  EXPECT_EQ(steps(dataset_options("v"), "-1"), "a_v_11.nvdb:990") << "components are x";
  EXPECT_EQ(steps(dataset_options("v"), "9:11"), "a_v_09.nvdb:810 a_v_10.nvdb:900");
  EXPECT_EQ(steps(dataset_options("w"), "-1,1"), "a_w_3_1.nvdb:240");
  EXPECT_EQ(steps(options_for("w", {false, 1}), "time=-1"), "a_w_y_3.nvdb:240");
  EXPECT_EQ(steps(options_for("w", {false, 1}), "2:"), "a_w_y_2.nvdb:168 a_w_y_3.nvdb:240");
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { steps(dataset_options("v"), "-1,0"); }),
            scratch_.path("a.h5") +
                ": --index has 2 positions, and /v has no leading axis; weir inspect lists what "
                "there is");
}

TEST_F(Hdf5Components, OnlyFieldOfVectorsIsTheDefaultOfComponent) {
  write_by_h5py(scratch_, R"(
v = values("f4", SHAPE + (3,))
expect("v", v[..., 1])
with h5py.File("a.h5", "w") as f:
    f["scalar"] = values("f4")
    f["v"] = v
)");
  expect_reads(scratch_, "a.h5", options_for("", {false, 1}), "v");
  EXPECT_EQ(message_of_error(ErrorKind::usage,
                             [&] {
                               open_source(scratch_.path("a.h5"), options_for("scalar", {true, 0}));
                             }),
            scratch_.path("a.h5") +
                ": /scalar: its axes are 5 x 7 x 9, none of them of components; leave "
                "--component out");
}

}  // namespace
}  // namespace weir::hdf5_components_test
