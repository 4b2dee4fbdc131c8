// The files that are removed beside a finished output.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "compressor/resume.h"
#include "format/base/error.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::discarded_leftovers_test {
namespace {

namespace fs = std::filesystem;

class DiscardedLeftovers : public testing::Test {
 protected:
  bool discard() { return discard_all_beside(*files_, output_); }

  TemporaryDirectory directory_;
  std::string output_ = directory_ / "a.nvdb";
  std::unique_ptr<FileSystem> files_ = make_posix_file_system();
};

TEST_F(DiscardedLeftovers, SomebodysFilesStay_AndNothingIsSaidToBeRemoved) {
  fs::create_directory(directory_ / ".a.nvdb.work");
  write_file(directory_ / ".a.nvdb.work/mine", "kept");
  EXPECT_FALSE(discard());
  EXPECT_TRUE(fs::exists(directory_ / ".a.nvdb.work/mine"));
  EXPECT_FALSE(fs::exists(output_ + ".partial"));
  fs::remove(directory_ / ".a.nvdb.work/mine");
  EXPECT_TRUE(discard());
  EXPECT_FALSE(fs::exists(directory_ / ".a.nvdb.work"));
  EXPECT_FALSE(discard());
}

TEST_F(DiscardedLeftovers, WhereTheyCannotBeRemoved_NoLockIsLeft) {
  fs::create_directory(directory_ / ".a.nvdb.work");
  fs::create_directory(directory_ / "a.nvdb.json.partial");
  EXPECT_THROW(discard(), Error);
  EXPECT_FALSE(fs::exists(output_ + ".partial"));
}

}  // namespace
}  // namespace weir::discarded_leftovers_test
