#include "daemon/output_cleaning.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <thread>

#include "format/file_system.h"
#include "tests/tools/run_command.h"

namespace weir {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;
using std::chrono::milliseconds;

TEST(OutputCleaning, RemovesWhatAKilledConversionLeavesAndNothingElse) {
  const TemporaryDirectory directory;
  fs::create_directories(directory / ".a.nvdb.work");
  fs::create_directories(directory / "deep/.b.nvdb.work");
  fs::create_directories(directory / "precious.nvdb.partial");  // a directory is nobody's partial file
  for (const char* name :
       {"a.nvdb.partial", "a.nvdb.json.partial", ".a.nvdb.png.123.partial", ".a.nvdb.work/spillAb3dE6",
        "deep/b.nvdb.partial", "done.nvdb", "done.nvdb.json", "done.nvdb.png", "notes.partial", "old.nvdb.json",
        "old.nvdb.json.previous", "lost.nvdb.json.previous"}) {
    write_file(directory / name, name);
  }
  const CleaningReport report = clean_outputs(directory.path().string(), false, milliseconds(0));
  EXPECT_EQ(report.left, Names{});
  EXPECT_EQ(report.removed,
            (Names{directory / ".a.nvdb.png.123.partial", directory / ".a.nvdb.work", directory / "a.nvdb.json.partial",
                   directory / "a.nvdb.partial", directory / "old.nvdb.json.previous"}));
  EXPECT_EQ(list_directory(directory.path()),
            (Names{"deep/", "deep/.b.nvdb.work/", "deep/b.nvdb.partial", "done.nvdb", "done.nvdb.json", "done.nvdb.png",
                   "lost.nvdb.json", "notes.partial", "old.nvdb.json", "precious.nvdb.partial/"}));
  EXPECT_EQ(read_file(directory / "lost.nvdb.json"), "lost.nvdb.json.previous") << "the record came back";
  clean_outputs(directory.path().string(), true, milliseconds(0));
  EXPECT_EQ(list_directory(directory / "deep"), Names{});
}

TEST(OutputCleaning, AMissingDirectoryHasNothingToRemove) {
  EXPECT_EQ(clean_outputs("/nowhere/at/all", true, milliseconds(0)).removed, Names{});
}

TEST(OutputCleaning, LeavesWhatIsBeingWritten) {
  const TemporaryDirectory directory;
  fs::create_directory(directory / ".a.nvdb.work");
  const auto writer = make_posix_file_system()->create(directory / "a.nvdb.partial");
  const CleaningReport report = clean_outputs(directory.path().string(), false, milliseconds(20));
  EXPECT_EQ(report.removed, Names{});
  EXPECT_EQ(report.left, Names{(directory / "a.nvdb.partial") + ": another process is writing it"});
  EXPECT_EQ(list_directory(directory.path()), (Names{".a.nvdb.work/", "a.nvdb.partial"}));
}

TEST(OutputCleaning, WaitsForAWriterThatIsDying) {
  const TemporaryDirectory directory;
  auto writer = make_posix_file_system()->create(directory / "a.nvdb.partial");
  const auto death = std::async(std::launch::async, [&] {
    std::this_thread::sleep_for(milliseconds(50));
    writer.reset();
  });
  EXPECT_EQ(clean_outputs(directory.path().string(), false, milliseconds(5000)).removed,
            Names{directory / "a.nvdb.partial"});
}

}  // namespace
}  // namespace weir
