// Reads virtual datasets. If all sources are there, the values are those that h5py reads. A missing source is an error
// and does not read as fill values.
#include "ingest/hdf5/virtual/virtual_boxes.h"

#include <filesystem>

#include "ingest/hdf5/virtual/virtual_mappings.h"
#include "tests/ingest/hdf5/support/h5py_file.h"
#include "tests/support/sanitized.h"

namespace weir::virtual_boxes_test {
namespace {

class VirtualDataset : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }
  std::string refused(const std::string& file, const SourceOptions& options = {}) {
    return message_of_error(ErrorKind::input, [&] { open_source(scratch_.path(file), options); });
  }

  Scratch scratch_;
};

TEST_F(VirtualDataset, ReadsSlabsPlanesAndInterleavedSources) {
  write_by_h5py(scratch_, R"(
v = values("f4", (6, 7, 9)); expect("v", v)
os.mkdir("parts")
def part(name, data, **how):
    with h5py.File("parts/" + name, "w") as f: f.create_dataset("deep/d", data=data, **how)
    return h5py.VirtualSource("parts/" + name, "deep/d", data.shape)
def whole(name, fill):
    layout = h5py.VirtualLayout((6, 7, 9), "f4")
    fill(layout)
    with h5py.File(name, "w") as f: f.create_virtual_dataset("v", layout, fillvalue=-1)

def slabs(layout):
    for i in range(3): layout[2*i:2*i+2] = part("slab%d" % i, v[2*i:2*i+2], chunks=(1, 7, 9), compression="gzip")
whole("slabs.h5", slabs)
def planes(layout):
    for i in range(6): layout[i] = part("plane%d" % i, v[i])
whole("planes.h5", planes)
def mosaic(layout):
    for i in range(2):
        for j in range(3): layout[:, (0, 3)[i]:(3, 7)[i], 3*j:3*j+3] = part("tile%d%d" % (i, j), v[:, (0, 3)[i]:(3, 7)[i], 3*j:3*j+3])
whole("mosaic.h5", mosaic)
def interleaved(layout):
    layout[::2] = part("even", v[::2])
    layout[1::2] = part("odd", v[1::2].astype(">f8"))
whole("interleaved.h5", interleaved)
def inner(layout):
    big = np.zeros((10, 10, 20), "f4"); big[2:8, 1:8, 3:12] = v
    layout[...] = part("big", big, chunks=(3, 3, 3))[2:8, 1:8, 3:12]
whole("inner.h5", inner)
with h5py.File("same.h5", "w") as f:
    f["real"] = v
    layout = h5py.VirtualLayout((6, 7, 9), "f4")
    layout[...] = h5py.VirtualSource(f["real"])
    f.create_virtual_dataset("v", layout)
)");
  for (const char* file : {"slabs.h5", "planes.h5", "mosaic.h5", "interleaved.h5", "inner.h5", "same.h5"}) {
    expect_reads(scratch_, file, dataset_options("v"), "v");
  }
  EXPECT_EQ(open_source(scratch_.path("slabs.h5"), {})->access().chunk, (Index3{9, 7, 1}));
}

TEST_F(VirtualDataset, ReadsStepsOfMoreSourcesThanMayBeOpen) {
  write_by_h5py(scratch_, R"(
import resource
v = values("i2", (40, 3, 5, 7))
layout = h5py.VirtualLayout(v.shape, "i2")
for i in range(40):
    with h5py.File("step%d.h5" % i, "w") as f: f["d"] = v[i]
    layout[i] = h5py.VirtualSource("step%d.h5" % i, "d", v.shape[1:])
with h5py.File("all.h5", "w") as f: f.create_virtual_dataset("v", layout)
layout = h5py.VirtualLayout((120, 5, 7), "i2")
for i in range(40): layout[3*i:3*i+3] = h5py.VirtualSource("step%d.h5" % i, "d", v.shape[1:])
with h5py.File("joined.h5", "w") as f: f.create_virtual_dataset("v", layout)
expect("17", v[17]); expect("joined", v.reshape(120, 5, 7))
)");
  expect_reads(scratch_, "all.h5", dataset_options("v", {17}), "17");
  expect_reads(scratch_, "joined.h5", {}, "joined");
  // Only the sources that the volume needs must be there.
  std::filesystem::remove(scratch_.path("step3.h5"));
  expect_reads(scratch_, "all.h5", dataset_options("v", {17}), "17");
  EXPECT_EQ(refused("all.h5", dataset_options("v", {3})),
            scratch_.path("all.h5") + ": /v: its source file step3.h5 is not there; put it beside " +
                scratch_.path("all.h5") + " or set HDF5_VDS_PREFIX");
}

TEST_F(VirtualDataset, ReadsMappingsOfUnlimitedExtent) {
  write_by_h5py(scratch_, R"(
v = values("f4", (6, 7, 9)); expect("v", v); expect("four", v[:4])
with h5py.File("grown.h5", "w", libver="latest") as f: f.create_dataset("d", data=v, maxshape=(None, 7, 9), chunks=(2, 7, 9))
for i in range(3):
    with h5py.File("block%d%%.h5" % i, "w", libver="latest") as f: f["d%d" % i] = v[2*i:2*i+2]
from h5py import h5s, h5p, h5d
U = h5s.UNLIMITED
def make(name, build):
    with h5py.File(name, "w", libver="latest") as f:
        space = h5s.create_simple((0, 7, 9), (U, 7, 9))
        made = h5p.create(h5p.DATASET_CREATE)
        build(space, made)
        space.select_all()
        h5d.create(f.id, b"v", h5py.h5t.IEEE_F32LE, space, made)
def endless(space, made):
    source = h5s.create_simple((0, 7, 9), (U, 7, 9))
    for s in (space, source): s.select_hyperslab((0, 0, 0), (1, 1, 1), None, (U, 7, 9))
    made.set_virtual(space, b"grown.h5", b"d", source)
make("endless.h5", endless)
def numbered(space, made):
    source = h5s.create_simple((2, 7, 9))
    space.select_hyperslab((0, 0, 0), (U, 1, 1), (2, 1, 1), (2, 7, 9))
    made.set_virtual(space, b"block%b%%.h5", b"d%b", source)
make("numbered.h5", numbered)
)");
  expect_reads(scratch_, "endless.h5", {}, "v");
  expect_reads(scratch_, "numbered.h5", {}, "v");
  // A numbered series ends before the first block that is missing, as in the library.
  std::filesystem::remove(scratch_.path("block2%.h5"));
  expect_reads(scratch_, "numbered.h5", {}, "four");
}

// A detector's frames have such elements between its modules. The library gives the fill value for them.
TEST_F(VirtualDataset, ElementsWithoutASource_ReadAsTheFillValueAndAreCounted) {
  write_by_h5py(scratch_, R"(
v = values("f4", (5, 7, 9))
with h5py.File("source.h5", "w") as f: f["d"] = v
layout = h5py.VirtualLayout((5, 7, 9), "f4")
layout[:, :3, :4] = h5py.VirtualSource("source.h5", "d", v.shape)[:, :3, :4]
layout[:, 4:, 5:] = h5py.VirtualSource("source.h5", "d", v.shape)[:, 4:, 5:]
steps = h5py.VirtualLayout((2, 5, 7, 9), "f4")
steps[0] = h5py.VirtualSource("source.h5", "d", v.shape)
with h5py.File("a.h5", "w") as f:
    f.create_virtual_dataset("v", layout, fillvalue=-1.5)
    f.create_virtual_dataset("steps", steps)
    expect("v", f["v"][()])
    expect("whole", v)
)");
  const std::string path = scratch_.path("a.h5");
  expect_reads(scratch_, "a.h5", dataset_options("v"), "v");
  expect_reads(scratch_, "a.h5", dataset_options("steps", {0}), "whole");
  const auto note = [&](const SourceOptions& options) {
    return open_source(path, options)->info().details.chunks_note;
  };
  EXPECT_EQ(note(dataset_options("v")), "195 of its 315 values have no source and read as its fill value, -1.5");
  EXPECT_EQ(note(dataset_options("steps", {0})), "");
  SourceOptions all = dataset_options("v");
  all.missing_chunks = MissingChunks::error;
  EXPECT_EQ(refused("a.h5", all), path +
                                      ": /v: 195 of its 315 values have no source (the first at 0, 0, 4), and with "
                                      "--missing-chunks error all must have one; map one to them, or use "
                                      "--missing-chunks fill");
  EXPECT_EQ(refused("a.h5", dataset_options("steps", {1})),
            path +
                ": /steps: no source is mapped to its element 1, 0, 0, 0, nor to any other of the volume; the "
                "dataset is incomplete");
}

TEST_F(VirtualDataset, ChunksThatASourceLacks_AreCountedWhereTheVolumeReadsThem) {
  write_by_h5py(scratch_, R"(
with h5py.File("source.h5", "w") as f:
    d = f.create_dataset("d", (2, 4, 4, 8), "f4", chunks=(1, 4, 4, 4), fillvalue=-7)
    d[0] = 1
    d[1, :, :, :4] = 2
layout = h5py.VirtualLayout((2, 4, 4, 8), "f4")
layout[...] = h5py.VirtualSource("source.h5", "d", (2, 4, 4, 8))
with h5py.File("a.h5", "w") as f:
    f.create_virtual_dataset("v", layout)
    expect("second", f["v"][1])
)");
  const std::string path = scratch_.path("a.h5");
  const auto note = [&](std::int64_t step, MissingChunks chunks) {
    SourceOptions options = dataset_options("v", {step});
    options.missing_chunks = chunks;
    return open_source(path, options)->info().details.chunks_note;
  };
  expect_reads(scratch_, "a.h5", dataset_options("v", {1}), "second");
  EXPECT_EQ(note(0, MissingChunks::error), "");
  EXPECT_EQ(note(1, MissingChunks::fill), "1 chunk of its sources was never written and reads as a fill value");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { note(1, MissingChunks::error); }),
            path + ": /v: 1 chunk of its sources was never written (the first at 1, 0, 0, 4 of " +
                scratch_.path("source.h5") +
                ": d), and with --missing-chunks error all must be; write them, or use --missing-chunks fill");
}

TEST_F(VirtualDataset, OfARegion_OnlyItsOwnSourcesAreNeeded) {
  write_by_h5py(scratch_, R"(
with h5py.File("source.h5", "w") as f:
    d = f.create_dataset("d", (4, 4, 8), "f4", chunks=(2, 4, 4), fillvalue=-7)
    d[:2] = 1
layout = h5py.VirtualLayout((8, 4, 9), "f4")
layout[:4, :, :8] = h5py.VirtualSource("source.h5", "d", (4, 4, 8))
layout[4:, :, :8] = h5py.VirtualSource("not_there_yet.h5", "d", (4, 4, 8))
with h5py.File("a.h5", "w") as f: f.create_virtual_dataset("v", layout, fillvalue=-1.5)
)");
  const std::string where = scratch_.path("a.h5") + ": /v: ";
  SourceOptions options = dataset_options("v");
  options.missing_chunks = MissingChunks::error;
  const auto said = [&](const Box& region) {
    options.roi = region;
    return message_of_error(ErrorKind::input, [&] { open_source(scratch_.path("a.h5"), options); });
  };
  options.roi = Box{{0, 0, 0}, {8, 4, 2}};
  EXPECT_EQ(all_values(*open_source(scratch_.path("a.h5"), options)), std::vector<float>(64, 1));
  const std::string all = "error all must ";
  EXPECT_EQ(said({{0, 0, 1}, {4, 4, 3}}), where + "1 chunk of its sources was never written (the first at 2, 0, 0 of " +
                                              scratch_.path("source.h5") + ": d), and with --missing-chunks " + all +
                                              "be; write them, or use --missing-chunks fill");
  EXPECT_EQ(said({{7, 0, 0}, {9, 4, 2}}),
            where + "8 of the region's 16 values have no source (the first at 0, 0, 8), and with --missing-chunks " +
                all + "have one; map one to them, or use --missing-chunks fill");
  options.missing_chunks = MissingChunks::fill;
  options.roi = Box{{8, 0, 0}, {9, 4, 2}};
  EXPECT_EQ(all_values(*open_source(scratch_.path("a.h5"), options)), std::vector<float>(8, -1.5F));
  EXPECT_EQ(open_source(scratch_.path("a.h5"), options)->info().details.chunks_note,
            "8 of the region's 8 values have no source and read as its fill value, -1.5");
  EXPECT_EQ(said({{0, 0, 3}, {4, 4, 5}}), where + "its source file not_there_yet.h5 is not there; put it beside " +
                                              scratch_.path("a.h5") + " or set HDF5_VDS_PREFIX");
}

TEST_F(VirtualDataset, SourcesThatWereNeverWritten_ReadAsTheFillValueThatTheirWriterSet) {
  write_by_h5py(scratch_, R"(
with h5py.File("source.h5", "w") as f:
    f["d"] = values("f4", (2, 4, 4))
    f.create_dataset("whole", (2, 4, 4), "f4", fillvalue=7)
    f.create_dataset("chunks", (2, 4, 4), "f4", chunks=(1, 4, 4), fillvalue=-2)
    f.create_dataset("netcdf", (2, 4, 4), "f4", fillvalue=np.float32(9.9692099683868690e36))
def virtual(name):
    layout = h5py.VirtualLayout((4, 4, 4), "f4")
    for at, d in ((0, "d"), (2, name)): layout[at:at + 2] = h5py.VirtualSource("source.h5", d, (2, 4, 4))
    f.create_virtual_dataset(name, layout, fillvalue=5)
    expect(name, f[name][()])
with h5py.File("a.h5", "w") as f:
    for name in ("whole", "chunks", "netcdf"): virtual(name)
)");
  const std::string path = scratch_.path("a.h5");
  const std::string source = scratch_.path("source.h5");
  const auto note = [&](const SourceOptions& options) {
    return open_source(path, options)->info().details.chunks_note;
  };
  expect_reads(scratch_, "a.h5", dataset_options("whole"), "whole");
  expect_reads(scratch_, "a.h5", dataset_options("chunks"), "chunks");
  EXPECT_EQ(note(dataset_options("whole")), "1 chunk of its sources was never written and reads as a fill value");
  EXPECT_EQ(note(dataset_options("chunks")), "2 chunks of its sources were never written and read as fill values");
  SourceOptions all = dataset_options("whole");
  all.missing_chunks = MissingChunks::error;
  EXPECT_EQ(refused("a.h5", all),
            path + ": /whole: 1 chunk of its sources was never written (the first at 0, 0, 0 of " + source +
                ": whole), and with --missing-chunks error all must be; write them, or use "
                "--missing-chunks fill");
  EXPECT_EQ(refused("a.h5", dataset_options("netcdf")),
            path + ": /netcdf: its source " + source +
                ": netcdf: no value was ever written to it; convert it when its values are there");
}

TEST_F(VirtualDataset, NamesTheSourceOrTheElementThatIsMissing) {
  const LeaksOfLibraries of_plugins;
  write_by_h5py(scratch_, R"(
def whole(name, pieces):
    layout = h5py.VirtualLayout((4, 4, 4), "f4")
    for where, source in pieces: layout[where] = source
    with h5py.File(name, "w") as f: f.create_virtual_dataset("v", layout, fillvalue=-1)
V = h5py.VirtualSource
with h5py.File("source.h5", "w") as f:
    f["half"] = np.ones((2, 4, 4), "f4")
    f["small"] = np.ones((2, 4, 3), "f4")
    f["flat"] = np.ones((2, 4), "f4")
    f.create_dataset("unwritten", (2, 4, 4), "f4")
    made = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    made.set_chunk((2, 4, 4)); made.set_filter(32028, h5py.h5z.FLAG_OPTIONAL, ())
    h5py.h5d.create(f.id, b"packed", h5py.h5t.IEEE_F32LE, h5py.h5s.create_simple((2, 4, 4)), made)
half = V("source.h5", "half", (2, 4, 4))
S = np.s_
whole("gap.h5", [(S[:2], half)])
with h5py.File("bare.h5", "w") as f:
    made = h5py.h5p.create(h5py.h5p.DATASET_CREATE); made.set_layout(h5py.h5d.VIRTUAL)
    h5py.h5d.create(f.id, b"v", h5py.h5t.IEEE_F32LE, h5py.h5s.create_simple((4, 4, 4)), made)
whole("no file.h5", [(S[:2], half), (S[2:], V("other.h5", "half", (2, 4, 4)))])
whole("no dataset.h5", [(S[:2], half), (S[2:], V("source.h5", "none", (2, 4, 4)))])
whole("small.h5", [(S[:2], half), (S[2:], V("source.h5", "small", (2, 4, 4)))])
whole("flat.h5", [(S[:2], half), (S[2:], V("source.h5", "flat", (2, 4, 4)))])
whole("unwritten.h5", [(S[:2], half), (S[2:], V("source.h5", "unwritten", (2, 4, 4)))])
whole("packed.h5", [(S[:2], half), (S[2:], V("source.h5", "packed", (2, 4, 4)))])
whole("nested.h5", [(S[...], V("gap.h5", "v", (4, 4, 4)))])
with h5py.File("raw source.h5", "w") as f: f.create_dataset("v", (4, 4, 4), "f4", external="raw")[...] = 1
whole("raw.h5", [(S[...], V("raw source.h5", "v", (4, 4, 4)))])
whole("cut.h5", [(S[:2], half), (S[2:], V("source.h5", "half", (9, 4, 4))[4:6])])
open("bad.h5", "w").write("nothing of HDF5 in here")
whole("bad source.h5", [(S[...], V("bad.h5", "v", (4, 4, 4)))])
)");
  const auto said = [&](const std::string& file) {
    const std::string start = scratch_.path(file) + ": /v: ";
    const std::string message = refused(file);
    EXPECT_TRUE(message.starts_with(start)) << message;
    return message.substr(std::min(start.size(), message.size()));
  };
  const std::string source = "its source " + scratch_.path("source.h5") + ": ";
  const std::string incomplete = "; the dataset is incomplete";
  EXPECT_EQ(said("bare.h5"), "no source is mapped to its element 0, 0, 0, nor to any other of the volume" + incomplete);
  EXPECT_EQ(said("cut.h5"), source + "half: has extents 2, 4, 4, fewer than the mapping needs");
  EXPECT_EQ(said("no file.h5"), "its source file other.h5 is not there; put it beside " + scratch_.path("no file.h5") +
                                    " or set HDF5_VDS_PREFIX");
  EXPECT_EQ(said("no dataset.h5"), source + "none cannot be opened: object 'none' doesn't exist");
  EXPECT_EQ(said("small.h5"), source + "small: has 24 elements where 32 are mapped");
  EXPECT_EQ(said("flat.h5"), source + "flat: has 8 elements where 32 are mapped");
  EXPECT_EQ(said("unwritten.h5"),
            source + "unwritten: no value was ever written to it; convert it when its values are there");
  EXPECT_EQ(said("packed.h5"), source +
                                   "packed: packed by the filter sperr (32028), and no plugin for it is found; "
                                   "set HDF5_PLUGIN_PATH to the directory that has it");
  EXPECT_EQ(said("nested.h5"),
            "its source " + scratch_.path("gap.h5") +
                ": v: is spread over other datasets itself; write it as one with h5repack -l CONTI " +
                scratch_.path("gap.h5") + " NEW, and put NEW in its place");
  EXPECT_EQ(said("raw.h5"), "its source " + scratch_.path("raw source.h5") +
                                ": v: has its values in external files; write it with the values in its own file");
  EXPECT_EQ(said("bad source.h5"), "its source " + scratch_.path("bad.h5") +
                                       ": no HDF5 signature at 0, 512, 1024 ...: the file is of another format than "
                                       "its name says, or its beginning is lost");
}

// Without a layout, h5repack copies a virtual dataset as a virtual one.
TEST_F(VirtualDataset, MappingsThatAreNotFollowed_AreRefusedWithTheCommandThatHelps) {
  write_by_h5py(scratch_, R"(
from h5py import h5s, h5p, h5d
U = h5s.UNLIMITED
with h5py.File("grown.h5", "w", libver="latest") as f: f.create_dataset("d", data=np.ones((6, 4, 4), "f4"), maxshape=(None, 4, 4), chunks=(2, 4, 4))
with h5py.File("a b.h5", "w", libver="latest") as f:
    space, source = (h5s.create_simple((0, 4, 4), (U, 4, 4)) for _ in range(2))
    space.select_hyperslab((0, 0, 0), (U, 1, 1), (2, 1, 1), (1, 4, 4))
    source.select_hyperslab((0, 0, 0), (1, 1, 1), None, (U, 4, 4))
    made = h5p.create(h5p.DATASET_CREATE)
    made.set_virtual(space, b"grown.h5", b"d", source)
    space.select_all()
    h5d.create(f.id, b"v", h5py.h5t.IEEE_F32LE, space, made)
)");
  EXPECT_EQ(refused("a b.h5"),
            scratch_.path("a b.h5") +
                ": /v: a mapping goes on without end in a way that weir does not follow; write it as one with h5repack "
                "-l CONTI '" +
                scratch_.path("a b.h5") + "' NEW");
}

TEST_F(VirtualDataset, SourcesLostAfterOpeningAreAnErrorToo) {
  write_by_h5py(scratch_, R"(
layout = h5py.VirtualLayout((16, 2, 2), "f4")
for i in range(8):
    with h5py.File("s%d.h5" % i, "w") as f: f["d"] = np.ones((2, 2, 2), "f4")
    layout[2*i:2*i+2] = h5py.VirtualSource("s%d.h5" % i, "d", (2, 2, 2))
with h5py.File("all.h5", "w") as f: f.create_virtual_dataset("v", layout)
)");
  const auto source = open_source(scratch_.path("all.h5"), {});
  std::filesystem::remove(scratch_.path("s6.h5"));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { all_values(*source); }),
            scratch_.path("all.h5") + ": /v: its source " + scratch_.path("s6.h5") +
                ": cannot open for reading: No such file or directory");
}

TEST(VirtualSourceName, PercentBIsReplacedByTheBlockNumber) {
  EXPECT_EQ(virtual_source_name("a.h5", 3), "a.h5");
  EXPECT_EQ(virtual_source_name("a%b-%b.h5", 12), "a12-12.h5");
  EXPECT_EQ(virtual_source_name("%%b", 1), "%b");
  EXPECT_EQ(virtual_source_name("50%", 1), "50%");
  EXPECT_EQ(virtual_source_name("%d%", 1), "%d%");
}

}  // namespace
}  // namespace weir::virtual_boxes_test
