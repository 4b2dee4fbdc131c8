// HDF5 files with a part that cannot be read, other than the values of a volume. A volume that depends on this part is
// refused. Objects that are only listed get a message.
#include <algorithm>

#include "format/base/text.h"
#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_damage_test {
namespace {

// For scripts: patch() writes `bytes` at the address `at` of the closed file `name`.
constexpr const char* kPatch = R"(
def patch(name, at, bytes):
    with open(name, "r+b") as f: f.seek(at); f.write(bytes)
)";

class Hdf5Damage : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }
  void write(const std::string& script) { write_by_h5py(scratch_, kPatch + script); }
  std::string refused(const std::string& file, const SourceOptions& options = {}) {
    return message_of_error(ErrorKind::input, [&] { all_values(*open_source(scratch_.path(file), options)); });
  }
  std::string list_refused(const std::string& file) {
    return message_of_error(ErrorKind::input, [&] { list_hdf5(scratch_.path(file), {}); });
  }
  std::vector<DatasetInfo> listed(const std::string& file) {
    SourceOptions options;
    options.lists_damaged = true;
    return list_hdf5(scratch_.path(file), options);
  }

  Scratch scratch_;
};

TEST_F(Hdf5Damage, DatasetThatCannotBeOpened_IsListedWithItsObstacleAndNotPassedOver) {
  write(R"(
with h5py.File("a.h5", "w", libver="latest") as f:
    f["bad"] = values("f4")
    f["good"] = values("f4"); expect("good", f["good"])
    at = h5py.h5o.get_info(f["bad"].id).addr
patch("a.h5", at, b"????")
)");
  const auto all = listed("a.h5");
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].name, "/bad");
  EXPECT_EQ(all[0].type, "");
  EXPECT_TRUE(all[0].obstacle.starts_with("cannot be opened: ") && all[0].obstacle.ends_with("; the file is damaged"))
      << all[0].obstacle;
  EXPECT_EQ(all[1].name, "/good");
  EXPECT_EQ(all[1].obstacle, "");
  const std::string at = scratch_.path("a.h5") + ": /bad: " + all[0].obstacle;
  EXPECT_EQ(list_refused("a.h5"), at);
  EXPECT_EQ(refused("a.h5"), at + ", and may hold a volume, too; choose one with --dataset, or copy the file again");
  expect_reads(scratch_, "a.h5", dataset_options("good"), "good");
}

TEST_F(Hdf5Damage, GroupThatCannotBeListed_IsSaid) {
  write(R"(
with h5py.File("a.h5", "w") as f: f["v"] = values("f4")
at = open("a.h5", "rb").read().index(b"SNOD")
patch("a.h5", at, b"????")
)");
  const auto all = listed("a.h5");
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].name, "/");
  EXPECT_TRUE(all[0].obstacle.starts_with("what it holds cannot be listed: ") &&
              all[0].obstacle.ends_with("; the file is damaged"))
      << all[0].obstacle;
  EXPECT_EQ(list_refused("a.h5"), scratch_.path("a.h5") + ": /: " + all[0].obstacle);
  EXPECT_EQ(refused("a.h5"), scratch_.path("a.h5") + ": /: " + all[0].obstacle +
                                 ", and may hold a volume, too; choose one with --dataset, or copy the file again");
}

TEST_F(Hdf5Damage, LinkToAFileThatIsNotThere_IsListedAndNoObstacleToOthers) {
  write(R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = values("f4"); expect("v", f["v"])
    f["away"] = h5py.ExternalLink("none.h5", "/v")
)");
  const auto all = listed("a.h5");
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[1].name, "/away");
  EXPECT_TRUE(all[1].obstacle.starts_with("leads to another file, and cannot be followed: ")) << all[1].obstacle;
  EXPECT_EQ(list_hdf5(scratch_.path("a.h5"), {}).size(), 1U);
  expect_reads(scratch_, "a.h5", {}, "v");
}

TEST_F(Hdf5Damage, OneLinkTooMany_IsSaid) {
  write(R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = values("f4")
    for i in range(258): f[f"away{i:03}"] = h5py.ExternalLink("none.h5", "/v")
)");
  const auto all = listed("a.h5");
  ASSERT_EQ(all.size(), 258U);
  EXPECT_EQ(all[0].name, "/away256");
  EXPECT_EQ(all[0].obstacle, "is a link to another file, and 256 of these are followed");
  EXPECT_EQ(list_refused("a.h5"),
            scratch_.path("a.h5") + ": /away256: is a link to another file, and 256 of these are followed");
}

TEST_F(Hdf5Damage, CoordinatesThatCannotBeRead_AreAnErrorThatNamesThem) {
  write(R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = values("f4", (4, 4, 4))
    z = f.create_dataset("z", data=np.arange(4.0), chunks=(4,), fletcher32=True)
    z.make_scale("z"); f["v"].dims[0].attach_scale(z)
    at = z.id.get_chunk_info(0).byte_offset
patch("a.h5", at, b"\1")
)");
  const std::string message = refused("a.h5", dataset_options("v"));
  EXPECT_TRUE(message.starts_with(scratch_.path("a.h5") + ": /z: its coordinates cannot be read: ") &&
              message.ends_with("; the file is cut short or damaged"))
      << message;
  const auto all = listed("a.h5");
  const auto volume = std::ranges::find(all, "/v", &DatasetInfo::name);
  ASSERT_NE(volume, all.end());
  EXPECT_EQ(volume->obstacle, message);
}

TEST_F(Hdf5Damage, ScaleThatIsGone_IsSaidOfTheAxis) {
  write(R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = values("f4", (4, 4, 4)); expect("v", f["v"])
    f["z"] = np.arange(4.0) * 3
    f["z"].make_scale("z"); f["v"].dims[0].attach_scale(f["z"])
    at = h5py.h5o.get_info(f["z"].id).addr
patch("a.h5", at, b"\xff" * 16)
)");
  const auto source = open_source(scratch_.path("a.h5"), dataset_options("v"));
  const std::string& note = source->info().details.axes[2].note;
  EXPECT_TRUE(note.starts_with("its coordinates cannot be opened (") && note.ends_with("), taken as indices")) << note;
  expect_reads(scratch_, "a.h5", dataset_options("v"), "v");
}

TEST_F(Hdf5Damage, AuxiliaryTimeThatCannotBeOpened_IsAnErrorThatNamesIt) {
  write(R"(
with h5py.File("a.h5", "w", libver="latest") as f:
    f["v"] = values("f4", (4, 4, 4))
    f["v"].attrs["coordinates"] = "time"
    f["time"] = 3.0
    at = h5py.h5o.get_info(f["time"].id).addr
patch("a.h5", at, b"????")
)");
  const std::string message = refused("a.h5", dataset_options("v"));
  EXPECT_TRUE(message.starts_with(scratch_.path("a.h5") + ": /: its member time cannot be opened: ") &&
              message.ends_with("; the file is damaged"))
      << message;
}

// The index has as many chunks as the dataset needs, but gives one of them a place that no chunk of the dataset has.
TEST_F(Hdf5Damage, ChunkThatTheIndexNamesElsewhere_IsAnErrorAndNoFillValue) {
  write_by_h5py(scratch_, R"(
import struct
with h5py.File("a.h5", "w") as f:
    f.create_dataset("d", data=np.arange(16**3, dtype="f4").reshape(16, 16, 16) + 1, chunks=(8, 8, 8), fletcher32=True)
b = bytearray(open("a.h5", "rb").read())
struct.pack_into("<Q", b, b.find(b"TREE\1") + 24 + 7 * 48 + 8 + 16, 24)
open("a.h5", "wb").write(b)
)");
  const std::unique_ptr<VolumeSource> source = open_source(scratch_.path("a.h5"), {});
  std::string message = message_of_error(ErrorKind::input, [&] { all_values(*source); });
  EXPECT_EQ(message, scratch_.path("a.h5") +
                         ": /d: chunk at 8, 8, 8: is not in the file's index, which has as many as there must be; the "
                         "file is damaged");
}

// The library would read as many bytes as the index says into memory of a chunk's size.
TEST_F(Hdf5Damage, ChunkOfAnotherLengthInTheIndex_IsAnErrorAndIsNotRead) {
  for (const std::string bytes : {"0", "1024", "4096", "2000000"}) {
    write_by_h5py(scratch_, cat(R"(
import struct
with h5py.File("a.h5", "w") as f:
    f.create_dataset("d", data=np.ones((16, 16, 16), "f4"), chunks=(8, 8, 8))
    f["behind"] = np.zeros(2000000, "u1")
b = bytearray(open("a.h5", "rb").read())
struct.pack_into("<I", b, b.find(b"TREE\1") + 24 + 48, )",
                                bytes, R"()
open("a.h5", "wb").write(b)
)"));
    EXPECT_EQ(refused("a.h5", dataset_options("d")),
              cat(scratch_.path("a.h5"), ": /d: its 8 chunks take ", 7 * 2048 + std::stoi(bytes),
                  " bytes by the index, and must take 16384; the file is damaged"));
  }
}

TEST_F(Hdf5Damage, IndexOfChunksThatCannotBeRead_IsNotCalledUnwritten) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f: f.create_dataset("d", data=np.ones((16, 16, 16), "f4"), chunks=(8, 8, 8), compression="gzip")
b = bytearray(open("a.h5", "rb").read())
b[b.find(b"TREE\1") + 2] = 0
open("a.h5", "wb").write(b)
)");
  const std::string message = message_of_error(ErrorKind::input, [&] { open_source(scratch_.path("a.h5"), {}); });
  EXPECT_TRUE(message.starts_with(scratch_.path("a.h5") +
                                  ": /d: its chunks cannot be counted, the file is damaged or being written: "))
      << message;
}

}  // namespace
}  // namespace weir::hdf5_damage_test
