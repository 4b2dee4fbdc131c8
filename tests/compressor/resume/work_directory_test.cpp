#include "compressor/resume/work_directory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"

namespace weir::work_directory_test {
namespace {

// A file system that remembers directories and says which of them lie in memory.
class Directories final : public FileSystem {
 public:
  std::vector<std::string> existing;
  std::vector<std::string> in_memory;

  std::unique_ptr<File> create(const std::string& path) override { return files_.create(path); }
  std::unique_ptr<File> open(const std::string& path) override { return files_.open(path); }
  std::unique_ptr<File> create_unnamed(const std::string& directory) override {
    return files_.create_unnamed(directory);
  }
  void rename(const std::string& from, const std::string& to) override { files_.rename(from, to); }
  void rename_new(const std::string& from, const std::string& to) override { files_.rename_new(from, to); }
  bool link(const std::string& from, const std::string& to) override { return files_.link(from, to); }
  void remove(const std::string& path) override { files_.remove(path); }
  void make_directory(const std::string& path) override { existing.push_back(path); }
  void remove_directory(const std::string& path) override { std::erase(existing, path); }
  void sync_directory(const std::string& path) override { files_.sync_directory(path); }
  bool exists(const std::string& path) override { return holds(existing, path); }
  bool is_memory(const std::string& directory) override { return holds(in_memory, directory); }
  std::uint64_t free_bytes(const std::string& directory) override { return files_.free_bytes(directory); }

 private:
  static bool holds(const std::vector<std::string>& list, const std::string& path) {
    return std::find(list.begin(), list.end(), path) != list.end();
  }
  test::CrashFileSystem files_;
};

std::string message_of(Directories& files, const std::string& output, const std::string& chosen,
                       ErrorKind kind = ErrorKind::usage) {
  return message_of_error(kind, [&] { const WorkDirectory work(files, output, chosen); });
}

TEST(WorkDirectory, IsHiddenBesideTheOutputAndGoneAfterwards) {
  Directories files;
  files.existing = {"/data", "."};
  {
    WorkDirectory work(files, "/data/out.nvdb", "");
    EXPECT_EQ(work.path(), "/data/.out.nvdb.work");
    EXPECT_TRUE(files.exists("/data/.out.nvdb.work"));
    EXPECT_NE(work.spill(), nullptr);
    const WorkDirectory relative(files, "out.nvdb", "");
    EXPECT_EQ(relative.path(), "./.out.nvdb.work");
  }
  EXPECT_EQ(files.existing, (std::vector<std::string>{"/data", "."}));
}

TEST(WorkDirectory, ChosenDirectoryIsKept) {
  Directories files;
  files.existing = {"/data", "/scratch"};
  {
    const WorkDirectory work(files, "/data/out.nvdb", "/scratch");
    EXPECT_EQ(work.path(), "/scratch");
  }
  EXPECT_EQ(files.existing, (std::vector<std::string>{"/data", "/scratch"}));
}

TEST(WorkDirectory, NeverLiesInMemory) {
  Directories files;
  files.existing = {"/dev/shm", "/var/tmp"};
  files.in_memory = {"/dev/shm"};
  {
    const WorkDirectory work(files, "/dev/shm/out.nvdb", "");
    EXPECT_EQ(work.path(), "/var/tmp");
  }
  EXPECT_EQ(files.existing.size(), 2U);
  EXPECT_EQ(message_of(files, "/var/tmp/out.nvdb", "/dev/shm"),
            "--work-dir /dev/shm: is a memory file system; choose a directory on a disk");
  files.in_memory = {"/dev/shm", "/var/tmp"};
  EXPECT_EQ(message_of(files, "/dev/shm/out.nvdb", ""),
            "/dev/shm/out.nvdb: lies on a memory file system, and so does /var/tmp; name a directory on a disk with "
            "--work-dir");
}

TEST(WorkDirectory, AMissingOneIsAnError) {
  Directories files;
  files.existing = {"/data"};
  EXPECT_EQ(message_of(files, "/data/out.nvdb", "/nowhere", ErrorKind::io),
            "--work-dir /nowhere: does not exist; make it or choose another");
}

TEST(WorkDirectory, OneBelowAFileIsAnErrorOfItsPath) {
  const TemporaryDirectory scratch;
  std::ofstream(scratch / "volume.raw") << "values";
  const std::string below = scratch / "volume.raw/d";
  Directories files;
  files.existing = {"/data"};
  EXPECT_EQ(message_of(files, "/data/out.nvdb", below, ErrorKind::io),
            below + ": cannot be --work-dir: Not a directory; correct the path, a part of which is a file");
}

TEST(WorkDirectory, AFileInItsPlaceIsAnError) {
  const TemporaryDirectory scratch;
  const std::string file = scratch / "volume.raw";
  std::ofstream(file) << "values";
  Directories files;
  files.existing = {"/data", file};
  EXPECT_EQ(message_of(files, "/data/out.nvdb", file), "--work-dir " + file + ": is a file; choose a directory");
}

}  // namespace
}  // namespace weir::work_directory_test
