#include "daemon/jobs/wrong_output.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/store/file_identity.h"
#include "format/base/text.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::wrong_output_test {
namespace {

using Names = std::vector<std::string>;

class WrongOutputTest : public testing::Test {
 protected:
  WrongOutputTest() {
    write_file(output_, "volume");
    write_file(output_ + ".json", "sidecar");
    verified_ = identify(output_);
  }

  std::string remove(FileSystem& files) const { return remove_wrong_output(files, output_, verified_); }
  /// Removes the output while call number `call` fails: 0 takes the lock, 1 and 2 remove, 3 flushes the directory.
  std::string remove_with_fault(int call) const {
    FaultyFileSystem files(*real_, call, EIO);
    return remove(files);
  }
  Names names() const { return list_directory(directory_.path().string()); }

  TemporaryDirectory directory_;
  std::string output_ = directory_ / "a.nvdb";
  std::unique_ptr<FileSystem> real_ = make_posix_file_system();
  std::optional<FileIdentity> verified_;
};

TEST_F(WrongOutputTest, VolumeAndSidecar_AreRemovedAndTheDirectoryFlushed) {
  FaultyFileSystem files(*real_, -1, 0);
  EXPECT_EQ(remove(files), "removed");
  EXPECT_EQ(files.calls(), (Names{"open", "remove", "remove", "sync_directory", "remove"}));
  EXPECT_EQ(names(), Names{});
}

TEST_F(WrongOutputTest, VolumeThatCannotBeRemoved_IsNamedAndKeepsItsSidecar) {
  const std::string outcome = remove_with_fault(1);
  EXPECT_EQ(outcome, cat("not removed: ", output_,
                         ": cannot do call 1 (remove): Input/output error; check the disk or the "
                         "file server; remove it and ",
                         output_, ".json"));
  EXPECT_EQ(names(), (Names{"a.nvdb", "a.nvdb.json"}));
}

TEST_F(WrongOutputTest, SidecarThatCannotBeRemoved_IsNamed) {
  const std::string outcome = remove_with_fault(2);
  EXPECT_EQ(outcome,
            cat("not removed: its sidecar, ", output_, ".json: cannot do call 2 (remove): Input/output ",
                "error; check the disk or the file server; remove ", output_, ".json before the next attempt"));
  EXPECT_EQ(names(), Names{"a.nvdb.json"});
}

TEST_F(WrongOutputTest, DirectoryThatCannotBeFlushed_IsSaid) {
  EXPECT_TRUE(remove_with_fault(3).starts_with("removed, which a crash may undo: "));
  EXPECT_EQ(names(), Names{});
}

TEST_F(WrongOutputTest, OutputThatAnotherProcessWrites_IsLeft) {
  const auto writer = real_->create(output_ + ".partial");
  EXPECT_EQ(remove(*real_),
            cat("not removed: ", output_,
                ".partial: is being written by another process or conversion; wait for it or choose another output"));
  EXPECT_EQ(names(), (Names{"a.nvdb", "a.nvdb.json", "a.nvdb.partial"}));
}

TEST_F(WrongOutputTest, OutputThatWasReplacedMeanwhile_IsLeft) {
  write_file(directory_ / "new", "another volume");
  std::filesystem::rename(directory_ / "new", output_);
  EXPECT_EQ(remove(*real_),
            cat("not removed: ", output_, " was replaced or written to since; the next attempt verifies it again"));
  EXPECT_EQ(names(), (Names{"a.nvdb", "a.nvdb.json"}));
}

// The file may be the lock of a killed commit, with a content that records it.
TEST_F(WrongOutputTest, LockThatWasLeftOver_Stays) {
  write_file(output_ + ".partial", "record");
  EXPECT_EQ(remove(*real_), "removed");
  EXPECT_EQ(read_file(output_ + ".partial"), "record");
}

}  // namespace
}  // namespace weir::wrong_output_test
