// Reads HDF5 datasets of every type and layout that h5py writes. Every value equals what h5py reads, bit for bit.
#include "ingest/hdf5/hdf5_source.h"

#include <atomic>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include "ingest/hdf5/file/hdf5_lock.h"
#include "tests/ingest/hdf5/support/h5py_file.h"
#include "tests/support/sanitized.h"

namespace weir::hdf5_source_test {
namespace {

class Hdf5Source : public ::testing::Test {
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

// The library reads unwritten chunks as the fill value and does not say so.
TEST_F(Hdf5Source, ChunksThatWereNeverWrittenAreSaidOrRefused) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("half", (32, 32, 32), "f4", chunks=(16, 16, 16), fillvalue=7.5)
    d[:16] = 1
    expect("half", d[()])
    d = f.create_dataset("steps", (3, 8, 10, 20), ">i2", chunks=(1, 8, 10, 16), fillvalue=-3)
    d[0] = 4
    d[1, :, :, :16] = 5
    d = f.create_dataset("vectors", (16, 4, 4, 3), "f4", chunks=(8, 4, 4, 3))
    d[8:] = 2
    d = f.create_dataset("apart", (4, 4, 8, 3), "f4", chunks=(4, 4, 4, 1))
    d[:, :, :, 0] = 2
    f.create_dataset("whole", data=np.ones((8, 8, 8), "f4"), chunks=(4, 4, 4))
)");
  const auto note = [&](const SourceOptions& options) {
    return open_source(scratch_.path("a.h5"), options)->info().details.chunks_note;
  };
  EXPECT_EQ(note(dataset_options("half")), "4 of its 8 chunks were never written and read as its fill value, 7.5");
  const auto source = open_source(scratch_.path("a.h5"), dataset_options("half"));
  EXPECT_EQ(all_values(*source), expected(scratch_, "half"));
  EXPECT_EQ(note(dataset_options("steps", {0})), "");
  EXPECT_EQ(note(dataset_options("steps", {1})), "1 of its 2 chunks was never written and reads as its fill value, -3");
  EXPECT_EQ(note(dataset_options("steps", {2})), "2 of its 2 chunks were never written and read as its fill value, -3");
  SourceOptions vectors = dataset_options("vectors");
  vectors.component = ComponentChoice{false, 1};
  EXPECT_EQ(note(vectors), "1 of its 2 chunks was never written and reads as its fill value, 0");
  SourceOptions apart = dataset_options("apart");
  apart.component = ComponentChoice{false, 0};
  EXPECT_EQ(note(apart), "");
  apart.component = ComponentChoice{false, 2};
  EXPECT_EQ(note(apart), "2 of its 2 chunks were never written and read as its fill value, 0");
  apart.component = ComponentChoice{true, 0};
  EXPECT_EQ(note(apart), "4 of its 6 chunks were never written and read as its fill value, 0");
  EXPECT_EQ(note(dataset_options("whole")), "");
  SourceOptions region = dataset_options("half");
  region.roi = VolumeRegion(Box{{0, 0, 0}, {32, 32, 16}});
  EXPECT_EQ(note(region), "");
  region.roi = VolumeRegion(Box{{0, 17, 15}, {16, 32, 17}});
  EXPECT_EQ(note(region), "1 of the region's 2 chunks was never written and reads as its fill value, 7.5");
  SourceOptions all = dataset_options("half");
  all.missing_chunks = MissingChunks::error;
  EXPECT_EQ(refused("a.h5", all), scratch_.path("a.h5") +
                                      ": /half: 4 of its 8 chunks were never written (the first at 16, 0, 0), and with "
                                      "--missing-chunks error all must be; write them, or use --missing-chunks fill");
  all.roi = VolumeRegion(Box{{0, 0, 0}, {4, 4, 16}});
  EXPECT_EQ(open_source(scratch_.path("a.h5"), all)->info().extent, (Index3{4, 4, 16}));
  all.roi.reset();
  all.dataset = "whole";
  EXPECT_EQ(open_source(scratch_.path("a.h5"), all)->info().extent, (Index3{8, 8, 8}));
}

TEST_F(Hdf5Source, ReadsEveryTypeInEveryLayout) {
  write_by_h5py(scratch_, R"(
with h5py.File("types.h5", "w") as f:
    for code in ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8"]:
        for order in "<>":
            v = values(order + code)
            name = code + ("le" if order == "<" else "be")
            expect(name, v)
            f["contiguous/" + name] = v
            f.create_dataset("chunked/" + name, data=v, chunks=(2, 3, 4))
            f.create_dataset("packed/" + name, data=v, chunks=(3, 4, 5), compression="gzip", shuffle=True, fletcher32=True)
            f.create_dataset("lzf/" + name, data=v, chunks=(3, 4, 5), compression="lzf", shuffle=True, fletcher32=True)
            f.create_dataset("szip/" + name, data=v, chunks=(2, 7, 4), compression="szip")
            compact = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
            compact.set_layout(h5py.h5d.COMPACT)
            group = f.require_group("compact")
            space = h5py.h5s.create_simple(SHAPE)
            d = h5py.h5d.create(group.id, name.encode(), h5py.h5t.py_create(v.dtype), space, compact)
            d.write(h5py.h5s.ALL, h5py.h5s.ALL, v)
)");
  for (const char* code : {"i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8"}) {
    for (const char* order : {"le", "be"}) {
      const std::string name = std::string(code) + order;
      for (const char* layout : {"contiguous/", "chunked/", "packed/", "lzf/", "szip/", "compact/"}) {
        expect_reads(scratch_, "types.h5", dataset_options(layout + name), name);
      }
    }
  }
}

// h5py stores truth values as an enumeration of int8. NetCDF-4 stores flags as an enumeration of any integer type.
TEST_F(Hdf5Source, Enumerations_ReadAsTheirIntegers) {
  write_by_h5py(scratch_, R"(
truth = rng.integers(0, 2, SHAPE).astype(bool); expect("truth", truth)
flags = rng.integers(0, 3, SHAPE) * 100; expect("flags", flags)
with h5py.File("a.h5", "w") as f:
    f["plain"] = truth
    f.create_dataset("packed", data=truth, chunks=(2, 3, 4), compression="gzip")
    kind = h5py.enum_dtype({"dry": 0, "wet": 100, "ice": 200, "none": 300}, basetype=">i2")
    f.create_dataset("flags", data=flags.astype(">i2"), dtype=kind)
    d = f.create_dataset("partly", (4, 5, 6), dtype=kind, chunks=(2, 5, 6), fillvalue=100)
    d[:2] = 200
    expect("partly", d[()].astype("i2"))
    f["flags"].attrs.create("_FillValue", 300, dtype=kind)
)");
  expect_reads(scratch_, "a.h5", dataset_options("plain"), "truth");
  expect_reads(scratch_, "a.h5", dataset_options("packed"), "truth");
  expect_reads(scratch_, "a.h5", dataset_options("flags"), "flags");
  expect_reads(scratch_, "a.h5", dataset_options("partly"), "partly");
  const auto flags = open_source(scratch_.path("a.h5"), dataset_options("flags"));
  EXPECT_EQ(flags->info().type, ScalarType::int16);
  EXPECT_EQ(flags->info().mapping.missing, std::vector<StoredValue>{std::int64_t{300}});
  const std::vector<DatasetInfo> list = list_hdf5(scratch_.path("a.h5"), {});
  ASSERT_EQ(list.size(), 4U);
  EXPECT_EQ(list[0].type, "big-endian int16 (enumeration of 4 names)");
  EXPECT_EQ(list[3].type, "int8 (boolean)");
  for (const DatasetInfo& listed : list) EXPECT_EQ(listed.obstacle, "") << listed.name;
}

TEST_F(Hdf5Source, InfoDescribesTheDataset) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("fields/rho: gas", data=values(">i2"), chunks=(2, 3, 4), compression="gzip")
    d.attrs["units"] = "kg m-3"
)");
  const auto source = open_source(scratch_.path("a.h5"), {});
  const SourceInfo& info = source->info();
  EXPECT_EQ(info.format, "hdf5");
  EXPECT_EQ(info.dataset, "/fields/rho: gas");
  EXPECT_EQ(info.units, "kg m-3");
  EXPECT_EQ(info.type, ScalarType::int16);
  EXPECT_EQ(info.extent, (Index3{9, 7, 5}));
  EXPECT_EQ(info.spacing, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(info.file_bytes, std::filesystem::file_size(scratch_.path("a.h5")));
  EXPECT_GT(info.mtime_ns, 0);
  EXPECT_EQ(source->access().chunk, (Index3{4, 3, 2}));
  EXPECT_EQ(source->access().bytes_per_voxel, 2U);
  EXPECT_GT(source->working_bytes(), 0U);
}

// weir itself decodes gzip and shuffle. The test sees this in bytes_read(), which counts unpacked bytes only for chunks
// that the library decodes.
TEST_F(Hdf5Source, DecodesGzipItself) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f.create_dataset("zeros", data=np.zeros((64, 64, 64), "f4"), chunks=(16, 16, 16), compression="gzip", shuffle=True)
    f.create_dataset("szip", data=np.zeros((64, 64, 64), "f4"), chunks=(16, 16, 16), compression="szip")
)");
  const auto own = open_source(scratch_.path("a.h5"), dataset_options("zeros"));
  all_values(*own);
  EXPECT_LT(own->bytes_read(), std::uint64_t{64} * 64 * 64);
  const auto library = open_source(scratch_.path("a.h5"), dataset_options("szip"));
  all_values(*library);
  EXPECT_EQ(library->bytes_read(), std::uint64_t{4} * 64 * 64 * 64);
  EXPECT_EQ(library->access().chunk, (Index3{16, 16, 16}));
}

TEST_F(Hdf5Source, ReadsBehindUserBlocksAndByAnyName) {
  write_by_h5py(scratch_, R"(
v = values("f4"); expect("v", v)
for size in [512, 1024, 4096]:
    with h5py.File("block%d.volume" % size, "w", userblock_size=size) as f:
        f["plain"] = v
        f.create_dataset("packed", data=v, chunks=(2, 3, 4), compression="gzip")
    with open("block%d.volume" % size, "r+b") as f: f.write(b"MATLAB 7.3 MAT-file")
)");
  for (const char* file : {"block512.volume", "block1024.volume", "block4096.volume"}) {
    expect_reads(scratch_, file, dataset_options("plain"), "v");
    expect_reads(scratch_, file, dataset_options("packed"), "v");
  }
}

TEST_F(Hdf5Source, FollowsLinks) {
  write_by_h5py(scratch_, R"(
v = values("f4"); expect("v", v)
os.mkdir("sub")
with h5py.File("sub/other.h5", "w") as f:
    f["deep/plain"] = v
    f.create_dataset("deep/packed", data=v, chunks=(2, 3, 4), compression="gzip")
    f["back"] = h5py.ExternalLink("../links.h5", "/")
with h5py.File("links.h5", "w") as f:
    f["a/real"] = v
    f["soft"] = h5py.SoftLink("/a/real")
    f["relative/soft"] = h5py.SoftLink("../a/real")
    f["hard"] = f["a/real"]
    f["a/loop"] = f["/"]
    f["plain"] = h5py.ExternalLink("sub/other.h5", "/deep/plain")
    f["group"] = h5py.ExternalLink("sub/other.h5", "/")
    f["nowhere"] = h5py.SoftLink("/none")
    f["lost"] = h5py.ExternalLink("none.h5", "/x")
    f["circle"] = h5py.SoftLink("/circle")
)");
  for (const char* name : {"soft", "hard", "a/loop/a/loop/a/real", "plain", "group/deep/packed", "group/deep/plain"}) {
    expect_reads(scratch_, "links.h5", dataset_options(name), "v");
  }
  const std::string path = scratch_.path("links.h5");
  EXPECT_EQ(refused("links.h5", dataset_options("nowhere")),
            path + ": /nowhere: a soft link to /none, which is not there");
  EXPECT_EQ(refused("links.h5", dataset_options("lost/y")),
            path + ": /lost: a link to /x of the file none.h5, which is not there; put the file beside this one");
  EXPECT_EQ(refused("links.h5", dataset_options("circle")),
            path + ": /circle: a soft link to /circle, which is not there");
  std::vector<std::string> names;
  for (const DatasetInfo& dataset : list_hdf5(path, {})) names.push_back(dataset.name);
  EXPECT_EQ(names, (std::vector<std::string>{"/hard", "/group/deep/packed", "/group/deep/plain"}));
}

TEST_F(Hdf5Source, FilesDigestCoversEveryFileTheDataLieIn) {
  write_by_h5py(scratch_, R"(
v = values("<f4")
with h5py.File("b.h5", "w") as f: f["d"] = v
with h5py.File("a.h5", "w") as f:
    f["own"] = v
    f["chunked"] = v
    f.create_dataset("external", data=v, external="e.raw")
    f["linked"] = h5py.ExternalLink("b.h5", "d")
    layout = h5py.VirtualLayout(SHAPE, "<f4")
    layout[...] = h5py.VirtualSource("b.h5", "d", SHAPE)
    f.create_virtual_dataset("virtual", layout)
    layout = h5py.VirtualLayout(SHAPE, "<f4")
    layout[...] = h5py.VirtualSource(f["own"])
    f.create_virtual_dataset("inner", layout)
)");
  const auto digest = [&](const char* name) {
    return open_source(scratch_.path("a.h5"), dataset_options(name))->info().files_digest;
  };
  for (const char* name : {"own", "chunked", "inner"}) EXPECT_EQ(digest(name), "") << name;
  for (const auto& [name, file] : {std::pair{"external", "e.raw"}, {"linked", "b.h5"}, {"virtual", "b.h5"}}) {
    const std::string before = digest(name);
    EXPECT_EQ(before.size(), 32U) << name;
    EXPECT_EQ(digest(name), before) << name;
    const std::string path = scratch_.path(file);
    std::filesystem::last_write_time(path, std::filesystem::last_write_time(path) - std::chrono::hours(1));
    EXPECT_NE(digest(name), before) << name;
  }
}

TEST_F(Hdf5Source, UnwrittenChunksReadAsTheFillValue) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name, fill, how in [("default", None, {}), ("seven", 7, {}), ("marked", -99, {}), ("szip", 7, {"compression": "szip"})]:
        d = f.create_dataset(name, (4, 4, 8), "f4", chunks=(4, 4, 4), fillvalue=fill, **how)
        d[:, :, :4] = 1
        expect(name, d[...])
    f["marked"].attrs["_FillValue"] = np.float32(-99)
)");
  for (const char* name : {"default", "seven", "szip"}) expect_reads(scratch_, "a.h5", dataset_options(name), name);
  const auto marked = open_source(scratch_.path("a.h5"), dataset_options("marked"));
  const std::vector<float> values = all_values(*marked);
  EXPECT_EQ(values[3], 1.0F);
  EXPECT_TRUE(is_missing(values[4]));
}

TEST_F(Hdf5Source, ReadsFiltersThatPluginsUndo) {
  const LeaksOfLibraries of_plugins;
  write_by_h5py(scratch_, R"(
v = values("f4"); expect("v", v)
with h5py.File("a.h5", "w") as f:
    f.create_dataset("scaleoffset", data=(v * 100).astype("i4"), chunks=(2, 3, 4), scaleoffset=0)
    expect("scaleoffset", (v * 100).astype("i4"))
    made = []
    for name, id, options in [("lz4", 32004, (0,)), ("bzip2", 307, (9,)), ("blosc", 32001, (0, 0, 0, 0, 5, 1, 0)),
                              ("zfp", 32013, (5, 0, 0, 0, 0, 0))]:
        if not h5py.h5z.filter_avail(id): continue
        f.create_dataset(name, data=v, chunks=(2, 3, 4), compression=id, compression_opts=options)
        expect(name, f[name][...])
        made.append(name)
    open("made", "w").write("\n".join(made))
)");
  expect_reads(scratch_, "a.h5", dataset_options("scaleoffset"), "scaleoffset");
  std::ifstream made(scratch_.path("made"));
  int count = 0;
  for (std::string name; std::getline(made, name); ++count) expect_reads(scratch_, "a.h5", dataset_options(name), name);
  if (count < 4) std::cout << "skipped: the HDF5 filter plugins of " << 4 - count << " filters are missing\n";
}

TEST_F(Hdf5Source, NamesTheFilterThatIsMissing) {
  const LeaksOfLibraries of_plugins;
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name, id in [("sperr", 32028), ("own", 65000)]:
        made = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        made.set_chunk((2, 2, 2))
        made.set_shuffle()
        made.set_filter(id, h5py.h5z.FLAG_OPTIONAL, ())
        d = h5py.h5d.create(f.id, name.encode(), h5py.h5t.IEEE_F32LE, h5py.h5s.create_simple((2, 2, 2)), made)
        d.write_direct_chunk((0, 0, 0), b"packed", 0)
)");
  EXPECT_EQ(refused("a.h5", dataset_options("sperr")),
            scratch_.path("a.h5") +
                ": /sperr: packed by the filter sperr (32028), and no plugin for it is found; set "
                "HDF5_PLUGIN_PATH to the directory that has it");
  EXPECT_EQ(refused("a.h5", dataset_options("own")),
            scratch_.path("a.h5") +
                ": /own: packed by the filter filter 65000 (65000), and no plugin for it is found; "
                "set HDF5_PLUGIN_PATH to the directory that has it");
}

TEST_F(Hdf5Source, SourcesReadFromManyThreadsAtOnce) {
  write_by_h5py(scratch_, R"(
v = values("f4", (32, 32, 32)); expect("v", v)
with h5py.File("a.h5", "w") as f:
    f["plain"] = v
    f.create_dataset("gzip", data=v, chunks=(8, 8, 8), compression="gzip")
    f.create_dataset("szip", data=v, chunks=(8, 8, 8), compression="szip")
)");
  const std::vector<float> whole = expected(scratch_, "v");
  std::vector<std::unique_ptr<VolumeSource>> sources;
  for (const char* name : {"plain", "gzip", "szip"}) {
    sources.push_back(open_source(scratch_.path("a.h5"), dataset_options(name)));
  }
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 6; ++t) {
    threads.emplace_back([&, t] {
      for (std::int64_t z = 0; z + 4 <= 32; ++z) {
        std::vector<float> part(4 * 32 * 32);
        sources[t % 3]->read({{0, 0, z}, {32, 32, z + 4}}, part);
        if (std::memcmp(part.data(), &whole[static_cast<std::size_t>(z * 1024)], part.size() * 4) != 0) ++wrong;
        open_source(scratch_.path("a.h5"), dataset_options("gzip"));  // other threads open and close files
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST_F(Hdf5Source, RefusesHugeChunksWithTheMemoryTheyTake) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f.create_dataset("v", data=np.zeros((64, 256, 256), "f4"), chunks=(64, 256, 256), compression="szip")
)");
  SourceOptions options = dataset_options("v");
  options.memory = std::uint64_t{32} << 20U;
  EXPECT_EQ(refused("a.h5", options, ErrorKind::usage),
            scratch_.path("a.h5") +
                ": /v: reading one of its chunks takes 52.0 MiB, more than half of --memory 32.0 "
                "MiB; give at least 117MiB");
}

TEST_F(Hdf5Source, LibraryErrorsAreNotPrintedToStderr) {
  write_by_h5py(scratch_, "h5py.File(\"a.h5\", \"w\")[\"v\"] = np.zeros((2, 2, 2))");
  testing::internal::CaptureStderr();
  refused("a.h5", dataset_options("none"));
  { open_source(scratch_.path("a.h5"), {}); }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace weir::hdf5_source_test
