#include "daemon/output_cleaning.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <thread>

#include "compressor/journal.h"
#include "daemon/file_identity.h"
#include "format/file_system.h"
#include "format/text.h"
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

// What an interrupted conversion of `source` to "a.nvdb" leaves, spill files in `spills` or beside it.
void leave_interrupted(const TemporaryDirectory& directory, const std::string& source, const std::string& spills = "") {
  const auto identity = identify(source);
  ASSERT_TRUE(identity);
  const auto files = make_posix_file_system();
  Journal journal(
      *files, directory / "a.nvdb",
      {{"source", source}, {"source bytes", cat(identity->bytes)}, {"source modified (ns)", cat(identity->mtime_ns)}},
      {spills, 0, nullptr, nullptr, {}});
  journal.open("rows")->preallocate(100);
  journal.state.survey.done.add({{0, 0, 0}, {1, 1, 1}});
  journal.save_now();
}

TEST(OutputCleaning, KeepsWhatCanBeContinuedAsLongAsItsSourceIsThere) {
  const TemporaryDirectory directory;
  const TemporaryDirectory sources;
  const std::string source = sources / "a.raw";
  write_file(source, "source");
  const auto clean = [&] { return clean_outputs(directory.path().string(), false, milliseconds(0)); };
  const Names kept{".a.nvdb.work/", ".a.nvdb.work/journal", ".a.nvdb.work/rows"};

  leave_interrupted(directory, source);
  write_file(directory / "a.nvdb.partial", "");
  EXPECT_EQ(clean().removed, Names{directory / "a.nvdb.partial"}) << "the lock of a process that is dead";
  EXPECT_EQ(list_directory(directory.path()), kept);

  write_file(source, "another source");
  EXPECT_EQ(clean().removed, Names{directory / ".a.nvdb.work"});
  EXPECT_EQ(list_directory(directory.path()), Names{});

  leave_interrupted(directory, source);
  fs::remove(source);
  EXPECT_EQ(clean().removed, Names{directory / ".a.nvdb.work"});

  write_file(source, "source");
  leave_interrupted(directory, source);
  fs::last_write_time(directory / ".a.nvdb.work", fs::file_time_type::clock::now() - std::chrono::hours(8 * 24));
  EXPECT_EQ(clean().removed, Names{directory / ".a.nvdb.work"}) << "for a week";

  leave_interrupted(directory, source);
  fs::resize_file(directory / ".a.nvdb.work/rows", 99);
  EXPECT_EQ(clean().removed, Names{directory / ".a.nvdb.work"}) << "worth nothing";
  EXPECT_EQ(list_directory(directory.path()), Names{});
}

TEST(OutputCleaning, RemovesSpillFilesWhereverTheyAre) {
  const TemporaryDirectory directory;
  const TemporaryDirectory elsewhere;
  write_file(elsewhere / "a.raw", "source");
  fs::create_directory(elsewhere / "spills");
  leave_interrupted(directory, elsewhere / "a.raw", elsewhere / "spills");
  EXPECT_EQ(list_directory(elsewhere / "spills").size(), 2U) << "a directory of its own and the rows";
  fs::remove(elsewhere / "a.raw");
  EXPECT_EQ(clean_outputs(directory.path().string(), false, milliseconds(0)).removed,
            Names{directory / ".a.nvdb.work"});
  EXPECT_EQ(list_directory(elsewhere / "spills"), Names{});
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
