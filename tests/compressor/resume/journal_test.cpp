#include "compressor/resume/journal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "tests/compressor/support/crash_file_system.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/temporary_directory.h"

namespace weir::journal_test {
namespace {

using test::CrashFileSystem;
using Names = std::vector<std::string>;

const ConversionIdentity kIdentity{{"source", "a"}, {"--rate", "8"}};
constexpr Box kSome{{0, 0, 0}, {4, 4, 1}};

Names saved_names() { return {"./.o.nvdb.work/journal", "./.o.nvdb.work/rows"}; }

// Begins a survey in `journal` with rows of 10 bytes.
void begin_survey(Journal& journal) {
  journal.open("rows")->preallocate(10);
  journal.state.survey.done.add(kSome);
}

TEST(Journal, WithoutASaveLeavesNothing) {
  CrashFileSystem files;
  {
    Journal journal(files, "o.nvdb", kIdentity, {});
    begin_survey(journal);
    EXPECT_EQ(journal.directory(), "./.o.nvdb.work");
    EXPECT_FALSE(journal.resumable());
  }
  EXPECT_EQ(files.names(), Names{});
}

TEST(Journal, SaveMakesTheDocumentedSequenceOfCalls) {
  CrashFileSystem memory;
  FaultyFileSystem files(memory, -1, 0);
  Journal journal(files, "o.nvdb", kIdentity, {});
  begin_survey(journal);
  const std::size_t before = files.calls().size();
  journal.save();
  const Names calls = files.calls();
  EXPECT_EQ(Names(calls.begin() + static_cast<std::ptrdiff_t>(before), calls.end()),
            (Names{"sync", "create", "write", "sync", "rename", "sync_directory", "sync_directory"}));
  EXPECT_TRUE(journal.resumable());
  journal.save();
  EXPECT_EQ(files.calls().size() - calls.size(), 6U) << "the hidden directory has its name by then";
}

TEST(Journal, ASaveOutlivesAPowerFailureWithItsDirectories) {
  for (const char* work_dir : {"", "/scratch"}) {
    CrashFileSystem files;
    const JournalOptions options{work_dir, 0, nullptr, nullptr, {}};
    {
      Journal journal(files, "o.nvdb", kIdentity, options);
      begin_survey(journal);
      journal.save();
    }
    const Names saved = files.names();
    files.lose_unflushed();
    EXPECT_EQ(files.names(), saved);
    EXPECT_TRUE(Journal(files, "o.nvdb", kIdentity, options).resumable());
  }
}

TEST(Journal, Paths_AreThoseOfEachFileThatItMakes) {
  CrashFileSystem files;
  Journal journal(files, "o.nvdb", kIdentity, {"/scratch", 0, nullptr, nullptr, {}});
  for (const char* name : {"rows", "faces", "ladders", "records", "volume"}) journal.open(name)->preallocate(10);
  journal.state.survey.done.add(kSome);
  journal.state.encoded.done.add(kSome);
  journal.save();
  const Names paths = journal.paths();
  EXPECT_EQ(paths.front(), "./.o.nvdb.work/journal");
  EXPECT_EQ(paths.back(), "./.o.nvdb.work");
  for (const std::string& name : files.names()) EXPECT_EQ(std::ranges::count(paths, name), 1) << name;
}

TEST(Journal, RestoresOnlyTheSavedState) {
  CrashFileSystem files;
  {
    Journal journal(files, "o.nvdb", kIdentity, {});
    begin_survey(journal);
    journal.save();
    journal.state.survey.done.add({{0, 0, 1}, {4, 4, 2}});  // not saved
    journal.open("volume")->preallocate(1000);              // none of its bytes count
  }
  EXPECT_EQ(files.names(), saved_names());
  std::string said;
  {
    Journal journal(files, "o.nvdb", kIdentity,
                    {"", 0, nullptr, nullptr, [&](const Message& line) { said = line.text(); }});
    EXPECT_TRUE(journal.resumable());
    EXPECT_EQ(journal.state.survey.done.boxes(), std::vector<Box>{kSome});
    EXPECT_EQ(journal.open("rows")->size(), 10U);
  }
  EXPECT_EQ(said, "");
  EXPECT_EQ(files.names(), saved_names()) << "a run that did nothing loses nothing";
  Journal(files, "o.nvdb", kIdentity, {}).discard();
  EXPECT_EQ(files.names(), Names{});
}

TEST(Journal, EncodedLeaves_KeepTheVolumeAndRecordFiles) {
  CrashFileSystem files;
  const Names all{"./.o.nvdb.work/journal", "./.o.nvdb.work/records", "./.o.nvdb.work/rows", "./.o.nvdb.work/volume"};
  {
    Journal journal(files, "o.nvdb", kIdentity, {});
    begin_survey(journal);
    journal.open("records")->preallocate(20);
    journal.open("volume")->preallocate(30);
    journal.state.encoded.done.add(kSome);
    journal.save();
  }
  EXPECT_EQ(files.names(), all);
  {
    Journal journal(files, "o.nvdb", kIdentity, {});
    EXPECT_EQ(journal.state.files,
              (std::map<std::string, std::uint64_t>{{"records", 20}, {"rows", 10}, {"volume", 30}}));
    journal.save();  // before any file is opened
  }
  EXPECT_EQ(files.names(), all);
  {
    Journal journal(files, "o.nvdb", kIdentity, {});
    journal.open("records");
    journal.open("volume");
    journal.state.encoded = {};
    journal.save();
  }
  EXPECT_EQ(files.names(), saved_names());
}

TEST(Journal, SpillFilesGoToTheChosenWorkDirectory) {
  CrashFileSystem files;
  {
    Journal journal(files, "o.nvdb", kIdentity, {"/scratch", 0, nullptr, nullptr, {}});
    begin_survey(journal);
    journal.save();
  }
  const Names names = files.names();
  ASSERT_EQ(names.size(), 2U);
  EXPECT_EQ(names[0], "./.o.nvdb.work/journal");
  EXPECT_TRUE(names[1].starts_with("/scratch/.o.nvdb.") && names[1].ends_with(".work/rows")) << names[1];
  std::string said;
  const Journal journal(files, "o.nvdb", kIdentity,
                        {"", 0, nullptr, nullptr, [&](const Message& line) { said = line.text(); }});
  EXPECT_TRUE(
      said.starts_with("o.nvdb: an interrupted conversion of it is not continued: its spill files were in "
                       "/scratch/.o.nvdb."))
      << said;
  EXPECT_EQ(files.names(), Names{}) << "wherever they are";
}

// If the output is moved or named by another path, the journal finds the files beside itself, and not the files beside
// a new output at the old place.
TEST(Journal, MovedOutput_ResumesFromTheFilesBesideIt) {
  const TemporaryDirectory directory;
  const auto files = make_posix_file_system();
  namespace fs = std::filesystem;
  fs::create_directory(directory / "a");
  const auto interrupt = [&](const std::string& output) {
    Journal journal(*files, output, kIdentity, {});
    begin_survey(journal);
    journal.save();
  };
  interrupt(directory / "a/o.nvdb");
  fs::rename(directory / "a", directory / "b");
  fs::create_directory(directory / "a");
  interrupt(directory / "a/o.nvdb");
  EXPECT_TRUE(Journal(*files, directory / "b/../b/o.nvdb", kIdentity, {}).resumable());
  EXPECT_TRUE(remove_leftovers(*files, directory / "b/o.nvdb"));
  EXPECT_FALSE(fs::exists(directory / "b/.o.nvdb.work/rows"));
  EXPECT_TRUE(read_journal(*files, directory / "a/o.nvdb"));
}

TEST(Journal, MovedOutput_KeepsTheSpillFilesOfANewOneAtItsOldPath) {
  const TemporaryDirectory directory;
  const auto files = make_posix_file_system();
  namespace fs = std::filesystem;
  fs::create_directory(directory / "a");
  fs::create_directory(directory / "scratch");
  const JournalOptions scratch{directory / "scratch", 0, nullptr, nullptr, {}};
  const auto interrupt = [&] {
    Journal journal(*files, directory / "a/o.nvdb", kIdentity, scratch);
    begin_survey(journal);
    journal.save();
  };
  interrupt();
  fs::rename(directory / "a", directory / "b");
  fs::create_directory(directory / "a");
  interrupt();
  EXPECT_FALSE(read_journal(*files, directory / "b/o.nvdb"));
  EXPECT_FALSE(Journal(*files, directory / "b/o.nvdb", kIdentity, scratch).resumable());
  EXPECT_TRUE(read_journal(*files, directory / "a/o.nvdb"));
}

// Two hosts have disks of their own and share one work directory.
TEST(Journal, WorkDirectoryWhereAnotherHostConvertsToTheSamePath_IsRefusedAndItsFilesStay) {
  const TemporaryDirectory directory;
  const auto files = make_posix_file_system();
  namespace fs = std::filesystem;
  fs::create_directory(directory / "a");
  fs::create_directory(directory / "scratch");
  const std::string output = directory / "a/o.nvdb";
  const JournalOptions scratch{directory / "scratch", 0, nullptr, nullptr, {}};
  for (const bool begun : {false, true}) {
    Journal one(*files, output, kIdentity, scratch);
    if (begun) {
      begin_survey(one);
      one.save();
    }
    const std::string rows = one.path_of("rows");
    fs::rename(directory / "a", directory / "disk of the first host");
    fs::create_directory(directory / "a");
    try {
      const Journal two(*files, output, kIdentity, scratch);
      ADD_FAILURE() << begun;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io);
      EXPECT_EQ(error.what(),
                rows + ": is being written by another process or conversion; wait for it or choose another output");
    }
    EXPECT_EQ(fs::file_size(rows), begun ? 10U : 0U);
    EXPECT_TRUE(fs::is_empty(directory / "a"));
    fs::remove(directory / "a");
    fs::rename(directory / "disk of the first host", directory / "a");
    one.discard();
  }
  EXPECT_TRUE(fs::is_empty(directory / "scratch"));
  EXPECT_FALSE(Journal(*files, output, kIdentity, scratch).resumable()) << "free again";
}

TEST(Journal, ContinuedConversion_HoldsItsSpillFilesFromTheStart) {
  const TemporaryDirectory directory;
  const auto files = make_posix_file_system();
  std::filesystem::create_directory(directory / "scratch");
  const JournalOptions scratch{directory / "scratch", 0, nullptr, nullptr, {}};
  {
    Journal journal(*files, directory / "o.nvdb", kIdentity, scratch);
    begin_survey(journal);
    journal.open("faces")->preallocate(20);
    journal.save();
  }
  const Journal journal(*files, directory / "o.nvdb", kIdentity, scratch);
  EXPECT_TRUE(journal.resumable());
  for (const char* name : {"rows", "faces"}) EXPECT_THROW(files->open(journal.path_of(name)), Error) << name;
  EXPECT_THROW(remove_leftovers(*files, directory / "o.nvdb"), Error);
  EXPECT_TRUE(std::filesystem::exists(directory / ".o.nvdb.work/journal"));
}

TEST(Journal, RemovesLeftoversOnceAndSaysWhetherThereWereAny) {
  CrashFileSystem files;
  {
    Journal journal(files, "o.nvdb", kIdentity, {"/scratch", 0, nullptr, nullptr, {}});
    begin_survey(journal);
    journal.save();
  }
  EXPECT_TRUE(read_journal(files, "o.nvdb"));
  EXPECT_TRUE(remove_leftovers(files, "o.nvdb"));
  EXPECT_EQ(files.names(), Names{});
  EXPECT_FALSE(read_journal(files, "o.nvdb"));
  EXPECT_FALSE(remove_leftovers(files, "o.nvdb"));
}

TEST(Journal, IsDueByTimeAndByCancellation) {
  CrashFileSystem files;
  std::atomic<bool> cancel{false};
  Journal journal(files, "o.nvdb", kIdentity, {"", 3600, &cancel, nullptr, {}});
  begin_survey(journal);
  EXPECT_FALSE(journal.due());
  cancel = true;
  EXPECT_TRUE(journal.due());
  journal.save();
  EXPECT_TRUE(journal.resumable()) << "waited for";
}

// The work goes on during a save, and gets the error at the next pause.
TEST(Journal, AFailedSaveIsReportedAndTheOneBeforeCounts) {
  CrashFileSystem memory;
  int sync = 0;
  {
    FaultyFileSystem none(memory, -1, 0);
    Journal journal(none, "o.nvdb", kIdentity, {});
    begin_survey(journal);
    journal.save();
    sync = static_cast<int>(none.calls().size());
    journal.discard();
  }
  FaultyFileSystem files(memory, sync, ENOSPC);  // the first call of the second save
  {
    Journal journal(files, "o.nvdb", kIdentity, {"", 1e-9, nullptr, nullptr, {}});
    begin_survey(journal);
    journal.save_now();
    journal.state.survey.done.add({{0, 0, 1}, {4, 4, 2}});
    journal.save();
    const auto fails = [&] {
      try {
        while (!journal.due()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return false;
      } catch (const Error& error) {
        return error.kind() == ErrorKind::io;
      }
    };
    EXPECT_TRUE(fails());
    EXPECT_TRUE(journal.resumable());
  }
  Journal journal(memory, "o.nvdb", kIdentity, {});
  EXPECT_EQ(journal.state.survey.done.boxes(), std::vector<Box>{kSome});
}

TEST(Journal, TheFilesOfALivingConversionAreLocked) {
  const TemporaryDirectory directory;
  const auto files = make_posix_file_system();
  Journal journal(*files, directory / "o.nvdb", kIdentity, {});
  begin_survey(journal);
  journal.save();
  try {
    read_journal(*files, directory / "o.nvdb");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(),
              directory / ".o.nvdb.work/rows" +
                  ": is being written by another process or conversion; wait for it or choose another output");
  }
}

}  // namespace
}  // namespace weir::journal_test
