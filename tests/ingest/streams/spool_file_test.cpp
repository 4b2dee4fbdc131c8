#include "ingest/streams/spool_file.h"

#include <cerrno>
#include <filesystem>

#include "tests/ingest/support/scratch.h"
#include "tests/support/faulty_file_system.h"

namespace weir::spool_file_test {
namespace {

std::vector<std::byte> bytes_of(std::size_t count, std::byte value) { return std::vector<std::byte>(count, value); }

class SpoolFileTest : public ::testing::Test {
 protected:
  SpoolFileTest() { options_.spool_directory = scratch_.path("."); }
  SpoolFile spool(std::uint64_t bytes) { return {*files_, options_, "data.gz", bytes}; }

  Scratch scratch_;
  std::unique_ptr<FileSystem> files_ = make_posix_file_system();
  SourceOptions options_;
};

TEST_F(SpoolFileTest, IsReadAfterItsWriterIsGone) {
  for (const DirectIo mode : {DirectIo::automatic, DirectIo::off}) {
    options_.direct_io = mode;
    std::unique_ptr<InputFile> file;
    {
      SpoolFile writer = spool(7);
      writer.write(bytes_of(3, std::byte{1}));
      writer.write({});
      writer.write(bytes_of(4, std::byte{2}));
      file = writer.finish();
    }
    EXPECT_EQ(file->path(), "data.gz (unpacked)");
    EXPECT_EQ(file->size(), 7);
    std::vector<std::byte> read(7);
    file->read_buffered(0, read, ReadPath::through);
    auto expected = bytes_of(3, std::byte{1});
    expected.insert(expected.end(), 4, std::byte{2});
    EXPECT_EQ(read, expected);
  }
}

TEST_F(SpoolFileTest, LeavesNoName) {
  SpoolFile writer = spool(2);
  writer.write(bytes_of(2, std::byte{1}));
  const auto file = writer.finish();
  EXPECT_TRUE(std::filesystem::is_empty(options_.spool_directory));
}

TEST_F(SpoolFileTest, RefusesMoreBytesThanExpected) {
  SpoolFile writer = spool(4);
  writer.write(bytes_of(3, std::byte{1}));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { writer.write(bytes_of(2, std::byte{1})); }),
            "data.gz: unpacks to more than the 4 bytes its header asks for; one of the two is damaged");
}

TEST_F(SpoolFileTest, RefusesFewerBytesThanExpected) {
  SpoolFile writer = spool(4);
  writer.write(bytes_of(3, std::byte{1}));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { writer.finish(); }),
            "data.gz: unpacks to 3 bytes, and its header asks for 4; the file is cut or one of the two is damaged");
}

TEST_F(SpoolFileTest, AFullDiskIsAnErrorOfTheDeviceAndLeavesNothing) {
  const std::vector<std::string> calls{"create_unnamed", "preallocate", "write"};
  for (int i = 0; i < 3; ++i) {
    FaultyFileSystem full(*files_, i, ENOSPC);
    const std::string message = message_of_error(ErrorKind::io, [&] {
      SpoolFile writer(full, options_, "data.gz", 4);
      writer.write(bytes_of(4, std::byte{1}));
    });
    EXPECT_TRUE(message.starts_with(options_.spool_directory)) << message;
    EXPECT_TRUE(message.ends_with(
        "No space left on device; free space on that file system or choose another with -o or --work-dir"))
        << message;
    EXPECT_EQ(full.calls().back(), calls[static_cast<std::size_t>(i)]);
    EXPECT_TRUE(std::filesystem::is_empty(options_.spool_directory));
  }
}

TEST_F(SpoolFileTest, AChosenDirectoryMustExist) {
  options_.spool_directory = scratch_.path("none");
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { spool(4); }),
            options_.spool_directory + ": cannot look at the file system: No such file or directory");
}

TEST_F(SpoolFileTest, NeverLiesOnAMemoryFileSystem) {
  if (!files_->exists("/dev/shm") || !files_->is_memory("/dev/shm")) GTEST_SKIP() << "no memory file system here";
  if (!files_->exists("/var/tmp") || files_->is_memory("/var/tmp")) GTEST_SKIP() << "no /var/tmp on a disk here";
  options_.spool_directory = "/dev/shm";
  FaultyFileSystem watched(*files_, 0, EACCES);
  EXPECT_EQ(
      message_of_error(ErrorKind::io, [&] { SpoolFile(watched, options_, "data.gz", 4); }),
      "/var/tmp: cannot do call 0 (create_unnamed): Permission denied; check the permissions or choose another place");
}

TEST_F(SpoolFileTest, LiesBesideThePackedFileWhereNoDirectoryIsChosen) {
  options_.spool_directory.clear();
  FaultyFileSystem watched(*files_, -1, 0);
  const std::string packed = scratch_.path("data.gz");
  SpoolFile writer(watched, options_, packed, 1);
  EXPECT_EQ(watched.calls(), (std::vector<std::string>{"create_unnamed", "preallocate"}));
  // If this user may not write to the directory of the data, the spool file lies in /var/tmp.
  FaultyFileSystem closed(*files_, 0, EACCES);
  SpoolFile elsewhere(closed, options_, packed, 1);
  EXPECT_EQ(closed.calls(), (std::vector<std::string>{"create_unnamed", "create_unnamed", "preallocate"}));
}

}  // namespace
}  // namespace weir::spool_file_test
