// The crash-safety protocol: every call of it fails in turn, and the directory is
// then compared exactly.
#include "format/output/output_files.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "format/base/error.h"
#include "format/output/commit_leftovers.h"
#include "format/sidecar/sidecar.h"
#include "tests/support/child_answer.h"
#include "tests/support/directory_contents.h"
#include "tests/support/faulty_file_system.h"
#include "tests/support/message_of_error.h"
#include "tests/support/temporary_directory.h"

namespace weir::output_files_test {
namespace {

class OutputFilesTest : public ::testing::Test {
 protected:
  std::string output() const { return directory_ / "out.nvdb"; }

  void put(const std::string& name, const std::string& text) const { std::ofstream(directory_ / name) << text; }

  Listing listing() const { return listing_of(directory_.path()); }

  // What a conversion does with its output; returns the error's message or nothing.
  std::string write_output(FileSystem& files, bool overwrite) const {
    try {
      OutputFiles output_files(files, output(), overwrite);
      output_files.reserve(6);
      output_files.volume().write_at(0, std::as_bytes(std::span("volume", 6)));
      output_files.commit("sidecar");
      return {};
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::io) << error.what();
      return error.what();
    }
  }

  const Listing written_{{"out.nvdb", "volume"}, {"out.nvdb.json", "sidecar"}};
  std::unique_ptr<FileSystem> real_ = make_posix_file_system();
  TemporaryDirectory directory_;
};

TEST_F(OutputFilesTest, WritesBothFilesAndNothingElse) {
  EXPECT_EQ(write_output(*real_, false), "");
  EXPECT_EQ(listing(), written_);
}

TEST_F(OutputFilesTest, ReservesAheadOnceAndKeepsWhatIsReserved) {
  for (const std::uint64_t reserved : {6U, 1000U, 2U}) {
    FaultyFileSystem files(*real_, -1, 0);
    OutputFiles output_files(files, output(), true);
    output_files.reserve_ahead(reserved);
    output_files.clear_for(6);
    EXPECT_EQ(output_files.volume().size(), reserved == 6 ? 6U : 0U);
    EXPECT_TRUE(output_files.reserve(6));
    const std::vector<std::string> once{"create", "preallocate"};
    const std::vector<std::string> anew{"create", "preallocate", "clear", "preallocate"};
    EXPECT_EQ(files.calls(), reserved == 6 ? once : anew);
    output_files.volume().write_at(0, std::as_bytes(std::span("volume", 6)));
    output_files.clear_for(6);  // of another attempt
    EXPECT_EQ(output_files.volume().size(), 0U) << "nothing of the one before is left";
    output_files.reserve(6);
    output_files.volume().write_at(0, std::as_bytes(std::span("volume", 6)));
    output_files.commit("sidecar");
    EXPECT_EQ(listing(), written_);
  }
}

TEST_F(OutputFilesTest, WhatCannotBeReservedAheadIsSaidWhenItIsReserved) {
  FaultyFileSystem files(*real_, 1, ENOSPC);
  OutputFiles output_files(files, output(), false);
  output_files.reserve_ahead(6);
  output_files.clear_for(6);
  EXPECT_EQ(output_files.volume().size(), 0U);
  EXPECT_EQ(files.calls(), (std::vector<std::string>{"create", "preallocate", "clear"}));
}

TEST_F(OutputFilesTest, MakesTheDocumentedSequenceOfCalls) {
  FaultyFileSystem files(*real_, -1, 0);
  EXPECT_EQ(write_output(files, false), "");
  const std::vector<std::string> expected{"create", "preallocate", "write",      "sync",       "create",
                                          "write",  "sync",        "rename_new", "rename_new", "sync_directory"};
  EXPECT_EQ(files.calls(), expected);
  FaultyFileSystem again(*real_, -1, 0);
  EXPECT_EQ(write_output(again, true), "");
  const std::vector<std::string> replacing{"create", "preallocate", "write",         "sync", "create",
                                           "write",  "sync",        "remove",        "link", "rename",
                                           "rename", "remove",      "sync_directory"};
  EXPECT_EQ(again.calls(), replacing);
}

TEST_F(OutputFilesTest, EachFailureOfANewOutputLeavesNothing) {
  constexpr int kCalls = 10;
  for (const int reason : {EIO, ENOSPC}) {
    for (int call = 0; call < kCalls; ++call) {
      FaultyFileSystem files(*real_, call, reason);
      const std::string message = write_output(files, false);
      EXPECT_TRUE(files.failed());
      EXPECT_NE(message.find("call " + std::to_string(call) + " "), std::string::npos) << message;
      // The last call flushes the directory: both files have their names by then.
      EXPECT_EQ(listing(), call + 1 < kCalls ? Listing{} : written_) << "call " << call;
      std::filesystem::remove(directory_ / "out.nvdb");
      std::filesystem::remove(directory_ / "out.nvdb.json");
    }
  }
}

TEST_F(OutputFilesTest, EachFailureOfAnOverwriteLeavesTheOldPair) {
  const Listing old{{"out.nvdb", "old volume"}, {"out.nvdb.json", "old sidecar"}};
  constexpr int kCalls = 13;
  for (int call = 0; call < kCalls; ++call) {
    for (const auto& [name, text] : old) put(name, text);
    FaultyFileSystem files(*real_, call, EIO);
    const std::string message = write_output(files, true);
    EXPECT_TRUE(files.failed());
    if (call < 11) {
      EXPECT_EQ(listing(), old) << "call " << call << ": " << message;
    } else if (call == 11) {
      // The second name of the old sidecar could not be removed: the result is in place all the same.
      Listing with_previous = written_;
      with_previous["out.nvdb.json.previous"] = "old sidecar";
      EXPECT_EQ(listing(), with_previous);
      EXPECT_EQ(message, "");
    } else {
      EXPECT_EQ(listing(), written_) << message;
    }
    std::filesystem::remove(directory_ / "out.nvdb.json.previous");
  }
}

TEST_F(OutputFilesTest, RefusesAnExistingOutput) {
  put("out.nvdb", "old volume");
  try {
    OutputFiles output_files(*real_, output(), false);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_EQ(std::string(error.what()), output() + ": exists; choose another output or pass --overwrite");
  }
  EXPECT_EQ(listing(), (Listing{{"out.nvdb", "old volume"}}));
}

// Killed between the two renames: the lock's file tells its sidecar from one that somebody keeps.
TEST_F(OutputFilesTest, ReplacesASidecarThatAKilledCommitLeft) {
  FaultyFileSystem files(*real_, 7, EIO, FaultyFileSystem::After::fails);  // the second rename
  {
    OutputFiles output_files(files, output(), false);
    output_files.write_to(real_->open(directory_ / "half"));
    EXPECT_THROW(output_files.commit("sidecar"), Error);
  }
  EXPECT_EQ(listing(),
            (Listing{{"half", ""}, {"out.nvdb.json", "sidecar"}, {"out.nvdb.partial", commit_record("sidecar")}}));
  std::filesystem::remove(directory_ / "half");
  EXPECT_EQ(write_output(*real_, false), "");
  EXPECT_EQ(listing(), written_);
}

TEST_F(OutputFilesTest, ForeignSidecarIsKeptAndTheOutputRefused) {
  put("out.nvdb.json", "kept");
  try {
    OutputFiles output_files(*real_, output(), false);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), output() + ".json: exists; choose another output or pass --overwrite");
  }
  EXPECT_EQ(listing(), (Listing{{"out.nvdb.json", "kept"}}));
}

// Even where the lock's file says that a killed commit placed this very text.
TEST_F(OutputFilesTest, TextLongerThanAnySidecarIsForeign) {
  const std::string text(kMostSidecarBytes + 1, ' ');
  put("out.nvdb.json", text);
  put("out.nvdb.partial", commit_record(text));
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { OutputFiles(*real_, output(), false); }),
            output() + ".json: exists; choose another output or pass --overwrite");
  EXPECT_EQ(listing().at("out.nvdb.json"), text);
}

TEST_F(OutputFilesTest, SecondWriterKeepsTheSidecarOfARunningCommit) {
  const OutputFiles first(*real_, output(), false);
  put("out.nvdb.json", "placed");  // as between its two renames
  EXPECT_EQ(write_output(*real_, false),
            output() +
                ".partial: is being written by another process or conversion; wait for it or choose "
                "another output");
  EXPECT_EQ(listing().at("out.nvdb.json"), "placed");
}

TEST_F(OutputFilesTest, KeepsAFileThatAppearedBeforeTheCommit) {
  OutputFiles output_files(*real_, output(), false);
  put("out.nvdb", "somebody else's");
  try {
    output_files.commit("sidecar");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
    EXPECT_EQ(std::string(error.what()),
              output() + ": appeared while it was written; choose another output or pass --overwrite");
    ASSERT_TRUE(error.system_failure());
    EXPECT_EQ(error.system_failure()->errno_value, EEXIST);
  }
  EXPECT_EQ(listing().at("out.nvdb"), "somebody else's");
  EXPECT_EQ(listing().count("out.nvdb.json"), 0U);
}

TEST_F(OutputFilesTest, SidecarThatAppearedBeforeTheCommit_IsKeptAndNamed) {
  OutputFiles output_files(*real_, output(), false);
  put("out.nvdb.json", "somebody else's");
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { output_files.commit("sidecar"); }),
            output() + ".json: appeared while it was written; choose another output or pass --overwrite");
  EXPECT_EQ(listing().at("out.nvdb.json"), "somebody else's");
  EXPECT_EQ(listing().count("out.nvdb"), 0U);
}

// Removed by somebody who took it for a leftover, and made anew by the next conversion, which has its own lock.
TEST_F(OutputFilesTest, PartialThatAnotherProcessMadeAnew_IsNeitherRenamedNorRemoved) {
  const Listing anothers{{"out.nvdb.partial", "another's half"}};
  for (const bool overwrite : {false, true}) {
    for (const bool in_another_place : {false, true}) {
      {
        OutputFiles output_files(*real_, output(), overwrite);
        if (in_another_place) output_files.write_to(real_->create(directory_ / "volume"));
        output_files.volume().write_at(0, std::as_bytes(std::span("volume", 6)));
        std::filesystem::remove(output() + ".partial");
        put("out.nvdb.partial", "another's half");
        EXPECT_EQ(message_of_error(ErrorKind::io, [&] { output_files.commit("sidecar"); }),
                  output() +
                      ".partial: was removed or replaced while it was written; let nobody remove it, and try "
                      "again");
        EXPECT_FALSE(output_files.committed());
      }
      std::filesystem::remove(directory_ / "volume");  // its owner's to remove
      EXPECT_EQ(listing(), anothers);
      std::filesystem::remove(output() + ".partial");
    }
  }
}

TEST_F(OutputFilesTest, VolumeThatWasRemovedMeanwhile_IsReportedAndLeavesTheOldPair) {
  const Listing old{{"out.nvdb", "old"}, {"out.nvdb.json", "old sidecar"}};
  for (const auto& [name, text] : old) put(name, text);
  {
    OutputFiles output_files(*real_, output(), true);
    output_files.write_to(real_->create(directory_ / "volume"));
    std::filesystem::remove(directory_ / "volume");
    EXPECT_EQ(message_of_error(ErrorKind::io, [&] { output_files.commit("sidecar"); }),
              directory_ / "volume" +
                  ": was removed or replaced while it was written; let nobody remove it, and try "
                  "again");
  }
  EXPECT_EQ(listing(), old);
}

// As where a program in Python forks a pool while it pushes.
TEST_F(OutputFilesTest, ForkedChildThatDestroysIt_RemovesNothing) {
  auto output_files = std::make_unique<OutputFiles>(*real_, output(), false);
  output_files->reserve_ahead(6);
  EXPECT_EQ(answer_of_child([&] {
              output_files.reset();
              return std::string("destroyed");
            }),
            "destroyed");
  EXPECT_EQ(listing().count("out.nvdb.partial"), 1U);
  output_files->clear_for(6);
  output_files->reserve(6);
  output_files->volume().write_at(0, std::as_bytes(std::span("volume", 6)));
  output_files->commit("sidecar");
  output_files.reset();
  EXPECT_EQ(listing(), written_);
}

TEST_F(OutputFilesTest, OpenToRead_NeitherCreatesNorLocksNorWrites) {
  const std::string file = directory_ / "file";
  EXPECT_EQ(message_of_error(ErrorKind::io, [&] { real_->open_to_read(file); }),
            file + ": cannot open for reading: No such file or directory");
  EXPECT_EQ(listing(), Listing{});
  put("file", "content");
  const auto writer = real_->open(file);
  const auto reader = real_->open_to_read(file);
  EXPECT_EQ(reader->size(), 7U);
  EXPECT_EQ(real_->open_to_read(file)->size(), 7U);
  EXPECT_THROW(reader->write_at(0, std::as_bytes(std::span("x", 1))), Error);
}

TEST_F(OutputFilesTest, SecondWriterOfTheSameOutputIsRefused) {
  const OutputFiles first(*real_, output(), false);
  try {
    const OutputFiles second(*real_, output(), false);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              output() +
                  ".partial: is being written by another process or conversion; wait for it or choose "
                  "another output");
  }
  EXPECT_EQ(listing().count("out.nvdb.partial"), 1U);
}

TEST_F(OutputFilesTest, TakesOverThePartialFileOfADeadProcess) {
  put("out.nvdb.partial", "half of somebody's volume, longer than ours");
  EXPECT_EQ(write_output(*real_, false), "");
  EXPECT_EQ(listing(), written_);
}

TEST_F(OutputFilesTest, VolumeAtAnotherPathIsMovedOnCommitOnly) {
  const std::string other = directory_ / "half";
  const auto write = [&](bool commits) {
    OutputFiles output_files(*real_, output(), false);
    output_files.write_to(real_->open(other));
    output_files.volume().write_at(0, std::as_bytes(std::span("volume", 6)));
    EXPECT_EQ(listing().at("out.nvdb.partial"), "") << "the lock";
    if (commits) output_files.commit("sidecar");
  };
  write(false);
  EXPECT_EQ(listing(), (Listing{{"half", "volume"}}));
  write(true);
  EXPECT_EQ(listing(), written_);
}

TEST_F(OutputFilesTest, OpenKeepsWhatAFileHoldsAndCreateDoesNot) {
  put("file", "content");
  EXPECT_EQ(real_->open(directory_ / "file")->size(), 7U);
  EXPECT_EQ(real_->open(directory_ / "new")->size(), 0U);
  EXPECT_EQ(real_->create(directory_ / "file")->size(), 0U);
}

TEST_F(OutputFilesTest, SaysThatTheDirectoryIsMissing) {
  const std::string path = directory_ / "absent/out.nvdb";
  try {
    OutputFiles output_files(*real_, path, false);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
    EXPECT_EQ(std::string(error.what()),
              path + ": the directory " + directory_ / "absent" + " does not exist; make it or choose another output");
  }
}

}  // namespace
}  // namespace weir::output_files_test
