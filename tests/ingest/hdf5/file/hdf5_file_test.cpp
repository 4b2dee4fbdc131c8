// HDF5 files that are cut short, damaged, locked, or being written.
#include "ingest/hdf5/file/hdf5_file.h"

#include <cstdlib>
#include <filesystem>

#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_file_test {
namespace {

class Hdf5File : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }
  std::string refused(const std::string& file, const SourceOptions& options = {}) {
    return message_of_error(ErrorKind::input, [&] { all_values(*open_source(scratch_.path(file), options)); });
  }

  Scratch scratch_;
};

TEST_F(Hdf5File, TruncatedFileIsReportedWithBothSizes) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f: f["v"] = values("f4")
)");
  const std::string path = scratch_.path("a.h5");
  const auto whole = std::filesystem::file_size(path);
  std::filesystem::resize_file(path, whole - 1);
  EXPECT_EQ(refused("a.h5"), path + ": cut short: it has " + std::to_string(whole - 1) + " bytes and says it has " +
                                 std::to_string(whole) + "; copy it again, or wait until it is written");
}

// The values are contiguous and chunked, the metadata old and new. However much of the file is left, reading gives all
// values or an error of one line.
TEST_F(Hdf5File, CutAtAnyByteIsAnErrorInOneLine) {
  write_by_h5py(scratch_, R"(
v = values("u1", (2, 3, 4)); expect("v", v)
for name, how in [("old", {}), ("new", {"libver": "latest"})]:
    with h5py.File(name + ".h5", "w", **how) as f:
        f["plain"] = v
        f.create_dataset("packed", data=v, chunks=(1, 3, 4), compression="gzip").attrs["units"] = "K"
)");
  const std::vector<float> whole = expected(scratch_, "v");
  for (const char* name : {"old.h5", "new.h5"}) {
    const std::string path = scratch_.path(name);
    // The sizes fall, because a file that grows again would wait for the device each time.
    for (auto size = std::filesystem::file_size(path) - 1; size > 0; --size) {
      std::filesystem::resize_file(path, size);
      for (const char* dataset : {"plain", "packed"}) {
        try {
          EXPECT_EQ(all_values(*open_source(path, dataset_options(dataset))), whole) << size;
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::input) << size << ": " << error.what();
          EXPECT_TRUE(std::string(error.what()).starts_with(path + ": ")) << error.what();
          EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
      }
    }
  }
}

// The files are cut, and the superblock states the new end, as a writer of before HDF5 1.10 that died leaves it.
TEST_F(Hdf5File, ValuesBeyondTheEndAreAnError) {
  write_by_h5py(scratch_, R"(
v = values("f4", (16, 16, 16))
with h5py.File("a.h5", "w") as f: f["plain"] = v
with h5py.File("b.h5", "w") as f: f.create_dataset("packed", data=v, chunks=(8, 8, 8), compression="gzip")
for name in "ab":
    data = bytearray(open(name + ".h5", "rb").read())
    del data[-2000:]
    data[40:48] = len(data).to_bytes(8, "little")
    open(name + ".h5", "wb").write(data)
)");
  const std::string plain = refused("a.h5");
  EXPECT_TRUE(plain.starts_with(scratch_.path("a.h5") + ": /plain: its values end 16384 bytes after 2048, and "))
      << plain;
  EXPECT_TRUE(plain.ends_with(" bytes; it is cut short or damaged")) << plain;
  const std::string packed = refused("b.h5");
  EXPECT_TRUE(packed.starts_with(scratch_.path("b.h5") + ": /packed: chunk at ")) << packed;
}

TEST_F(Hdf5File, IsRecognisedBySignatureThenByName) {
  const auto named = [&](const std::string& name, const std::string& text) {
    scratch_.write(name, std::as_bytes(std::span(text)));
    return refused(name);
  };
  const std::string none =
      ": no HDF5 signature at 0, 512, 1024 ...: the file is of another format than its name says, "
      "or its beginning is lost";
  for (const char* name : {"a.h5", "a.hdf5", "a.he5", "a.nc", "a.nc4"}) {
    EXPECT_EQ(named(name, "what?"), scratch_.path(name) + none);
  }
  EXPECT_EQ(
      named("classic", std::string("CDF\1", 4) + "rest"),
      scratch_.path("classic") + ": NetCDF of before version 4, which is not HDF5; convert it with nccopy -k nc4");
  EXPECT_EQ(
      named("half.h5", "\x89HDF\r\n\x1a\n"),
      scratch_.path("half.h5") +
          ": cannot be opened as HDF5 (bad byte number in an address); the file is damaged or still being written");
  EXPECT_EQ(format_of(scratch_.write("a_2x2x2_uint8.raw", std::vector<std::byte>(8))).name, "raw");
}

TEST_F(Hdf5File, FileOpenForWritingIsReadOnlyInSwmrMode) {
  write_by_h5py(scratch_, R"(
v = values("f4", (4, 6, 8)); expect("v", v)
with h5py.File("a.h5", "w", libver="latest") as f:
    f.create_dataset("v", data=v, chunks=(2, 3, 4), maxshape=(None, 6, 8), compression="gzip")
)");
  // The writer is a process of its own, because within one process the library shares the open file.
  const std::string script = std::string(kPrelude) + R"(
f = h5py.File("a.h5", "r+", libver="latest")
if sys.argv[2] == "swmr": f.swmr_mode = True
print("ready", flush=True)
sys.stdin.readline()
)";
  for (const bool readers : {true, false}) {
    const std::string hold = scratch_.path("hold");
    const std::string ready = scratch_.path("ready");
    ASSERT_EQ(std::system(("rm -f '" + hold + "' '" + ready + "'; mkfifo '" + hold + "'").c_str()), 0);
    const std::string start = kPython + " -c '" + script + "' '" + scratch_.path("") + "' " +
                              (readers ? "swmr" : "alone") + " < '" + hold + "' > '" + ready + "' &";
    ASSERT_EQ(std::system(start.c_str()), 0);
    std::ofstream writer(hold);  // opens once Python reads the pipe; Python ends when this closes
    for (int i = 0; i < 500 && (!std::filesystem::exists(ready) || std::filesystem::is_empty(ready)); ++i) {
      ASSERT_EQ(std::system("sleep 0.02"), 0);
    }
    if (readers) {
      expect_reads(scratch_, "a.h5", {}, "v");
    } else {
      EXPECT_EQ(refused("a.h5"), scratch_.path("a.h5") +
                                     ": locked by a program that has it open for writing; wait until that closes it or "
                                     "writes for readers (SWMR), or, where no program has it open, set "
                                     "HDF5_USE_FILE_LOCKING=FALSE");
    }
    writer.close();
    ASSERT_EQ(
        std::system(("for i in $(seq 100); do flock -n '" + scratch_.path("a.h5") + "' true && break; sleep 0.05; done")
                        .c_str()),
        0);
  }
}

TEST_F(Hdf5File, FileLeftOpenByADeadWriterIsRefused) {
  write_by_h5py(scratch_, R"(
f = h5py.File("a.h5", "w", libver="latest")
f["v"] = values("f4")
f.flush()
os._exit(0)
)");
  EXPECT_EQ(refused("a.h5"), scratch_.path("a.h5") +
                                 ": marked as open for writing, and not for readers beside (SWMR): a program still "
                                 "writes it or died at it; wait until it is closed, or clear the mark with h5clear -s");
}

// Extents that the file only claims cause no allocation, no overflow and no hang.
TEST_F(Hdf5File, HostileExtentsAreAnError) {
  write_by_h5py(scratch_, R"(
import struct
def claim(name, dims, rank=3, **how):
    real = (2,) * (rank - 3) + (11, 13, 17)
    with h5py.File(name, "w") as f: f.create_dataset("v", data=np.zeros(real, "f4"), **how)
    data = open(name, "rb").read()
    old, new = struct.pack("<%dQ" % rank, *real), struct.pack("<%dQ" % rank, *dims)
    assert data.count(old) > 0
    open(name, "wb").write(data.replace(old, new))
gzip = {"chunks": (4, 4, 4), "compression": "gzip"}
for name, dims in [("wide", (2, 2, 2**31)), ("huge", (2**30, 2**30, 2**30)), ("negative", (2**64 - 2, 2, 2)), ("large", (1000, 1000, 1000))]:
    claim(name + ".h5", dims)
    claim(name + " packed.h5", dims, **gzip)
claim("deep.h5", (2**62, 11, 13, 17), 4)
claim("deep packed.h5", (2**62, 11, 13, 17), 4, chunks=(1, 4, 4, 4))
)");
  for (const char* name :
       {"wide.h5", "wide packed.h5", "huge.h5", "huge packed.h5", "negative.h5", "negative packed.h5", "large.h5"}) {
    EXPECT_TRUE(message_of_error(ErrorKind::input, [&] { open_source(scratch_.path(name), {}); })
                    .starts_with(scratch_.path(name) + ": "))
        << name;
  }
  for (const char* name : {"deep.h5", "deep packed.h5"}) {
    EXPECT_TRUE(message_of_error(ErrorKind::input, [&] { open_source(scratch_.path(name), dataset_options("v", {5})); })
                    .starts_with(scratch_.path(name) + ": /v: "))
        << name;
  }
  // Unwritten chunks are not allocated, so a volume of mostly unwritten chunks can be read.
  std::vector<float> values(8);
  open_source(scratch_.path("large packed.h5"), {})->read({{990, 990, 990}, {992, 992, 992}}, values);
  EXPECT_EQ(values, std::vector<float>(8, 0.0F));
}

}  // namespace
}  // namespace weir::hdf5_file_test
