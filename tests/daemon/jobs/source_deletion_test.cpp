// When sources are deleted, and what an interrupted deletion leaves.
#include "daemon/jobs/source_deletion.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <sys/mman.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>

#include "format/io/descriptor.h"
#include "tests/daemon/support/deleting_watch.h"

namespace weir::source_deletion_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

using SourceDeletionTest = DeletingWatch;

TEST_F(SourceDeletionTest, SourceIsDeletedAfterTheDelay) {
  config_.watches[0].delete_after_s = 0.3;
  delete_done();
  EXPECT_FALSE(run_until([&] { return !fs::exists(source_); }, milliseconds(150)));
  EXPECT_TRUE(run_until([&] { return !fs::exists(source_); }));
  EXPECT_TRUE(logged(" deleted job=1 source=" + source_ + " in_use=no"));
}

TEST_F(SourceDeletionTest, MarkerIsDeletedWithItsSource) {
  config_.watches[0].complete = Completion::marker;
  write_file(source_ + ".done", "");
  delete_done();
  EXPECT_FALSE(stays());
  EXPECT_FALSE(fs::exists(source_ + ".done"));
}

TEST_F(SourceDeletionTest, OpenForWriting_WaitsForTheClose) {
  Descriptor writer(::open(source_.c_str(), O_WRONLY | O_CLOEXEC));
  delete_done();
  ASSERT_TRUE(run_until([&] { return logged("a program has it open for writing; tried again later"); }));
  EXPECT_TRUE(fs::exists(source_));
  writer.reset();
  EXPECT_FALSE(stays());
}

// As numpy.memmap does: nothing is written, closed or timed until the memory is given back.
TEST_F(SourceDeletionTest, MappedForWriting_WaitsForTheEndOfTheMapping) {
  Descriptor writer(::open(source_.c_str(), O_RDWR | O_CLOEXEC));
  void* const mapping = ::mmap(nullptr, 6, PROT_READ | PROT_WRITE, MAP_SHARED, writer.get(), 0);
  ASSERT_NE(mapping, MAP_FAILED);
  writer.reset();
  delete_done();
  ASSERT_TRUE(run_until([&] { return logged("a program has it open for writing; tried again later"); }));
  EXPECT_TRUE(fs::exists(source_));
  ASSERT_EQ(::munmap(mapping, 6), 0);
  EXPECT_FALSE(stays());
}

TEST_F(SourceDeletionTest, OpenForReading_IsNoObstacle) {
  const std::ifstream reader(source_);
  delete_done();
  EXPECT_FALSE(stays());
}

TEST_F(SourceDeletionTest, ChangedInTheMeantime_Stays) {
  config_.watches[0].delete_after_s = 0.2;
  delete_done();
  std::ofstream(source_, std::ios::app) << "more";
  EXPECT_TRUE(stays());
}

TEST_F(SourceDeletionTest, RetriedJob_KeepsItsSource) {
  config_.watches[0].delete_after_s = 0.1;
  delete_done();
  store_.retry(1);
  EXPECT_TRUE(stays());
}

TEST_F(SourceDeletionTest, ReplacedByOneOfTheSameSizeTimeAndInode_Stays) {
  config_.watches[0].delete_after_s = 0.2;
  const auto time = fs::last_write_time(source_);
  delete_done();
  write_file(source_, "others");
  fs::last_write_time(source_, time);
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged(sidecar_path(output_) + " is of another file, or of this one as it was before"));
}

TEST_F(SourceDeletionTest, SourceThatTheWatchNoLongerTakes_Stays) {
  convert();
  WatchConfig& watch = config_.watches[0];
  const WatchConfig before = watch;
  watch.exclude = {"a*"};
  deletion_.configure(config_);
  EXPECT_TRUE(stays()) << "excluded";
  watch = before;
  watch.convert_options = {"--rate=2"};
  deletion_.configure(config_);
  EXPECT_TRUE(stays()) << "another rate";
  watch = before;
  watch.directory = directory_ / "other";
  deletion_.configure(config_);
  EXPECT_TRUE(stays()) << "another directory";
}

TEST_F(SourceDeletionTest, WhileJobsAreHeld_NothingIsDeleted) {
  held_ = true;
  delete_done();
  EXPECT_FALSE(run_until([&] { return !fs::exists(source_); }, milliseconds(300)));
  EXPECT_FALSE(deletion_.idle());
}

// logrotate has the service reload: a delay of a week would never end.
TEST_F(SourceDeletionTest, Reload_GoesOnWaitingUnderTheSameDelay) {
  config_.watches[0].delete_after_s = 0.6;
  delete_done();
  const auto end = std::chrono::steady_clock::now() + milliseconds(2000);
  while (fs::exists(source_) && std::chrono::steady_clock::now() < end) {
    run_until([] { return false; }, milliseconds(50));
    deletion_.configure(config_);
  }
  EXPECT_FALSE(fs::exists(source_));
}

TEST_F(SourceDeletionTest, Reload_WaitsAgainUnderAnotherDelay) {
  config_.watches[0].delete_after_s = 0.2;
  delete_done();
  config_.watches[0].delete_after_s = 3600;
  deletion_.configure(config_);
  EXPECT_FALSE(run_until([&] { return !fs::exists(source_); }, milliseconds(500)));
}

// One whose hidden name is taken keeps none of those behind it waiting.
TEST_F(SourceDeletionTest, WhatCannotBeDeleted_IsSaidAndTheNextOneGoes) {
  const std::int64_t id = convert();
  write_file(hidden(id), "left by another deletion");
  const std::string first = std::exchange(source_, directory_ / "in/b_1x2x3_uint8.raw");
  output_ = directory_ / "out/b.nvdb";
  write_file(source_, "others");
  std::this_thread::sleep_for(milliseconds(20));
  write_output("");
  convert();
  deletion_.configure(config_);
  EXPECT_FALSE(stays());
  EXPECT_TRUE(fs::exists(first));
  EXPECT_EQ(read_file(hidden(id)), "left by another deletion");
}

TEST_F(SourceDeletionTest, MarkerThatCannotBeRemoved_IsSaid) {
  config_.watches[0].complete = Completion::marker;
  fs::create_directories(source_ + ".done/not empty");
  delete_done();
  EXPECT_FALSE(stays());
  EXPECT_TRUE(logged(" marker-stays job=1 reason="));
}

// Its certificate may be of one file: where the hierarchy has no chunk yet.
TEST_F(SourceDeletionTest, HeadOfADirectory_Stays) {
  config_.watches[0].recursive = true;
  fs::create_directory(directory_ / "in/a.zarr");
  for (const char* head : {"zarr.json", ".zgroup", ".zarray"}) {
    source_ = directory_ / "in/a.zarr/" + head;
    write_file(source_, "values");
    std::this_thread::sleep_for(milliseconds(20));
    write_output("");
    delete_done();
    EXPECT_TRUE(stays()) << head;
    EXPECT_TRUE(logged(source_ + " reason=\"it stands for a directory, whose files are never deleted\"")) << head;
  }
}

TEST_F(SourceDeletionTest, DoneByAnEarlierProcess_IsDeleted) {
  convert();
  deletion_.configure(config_);
  EXPECT_FALSE(deletion_.idle());
  EXPECT_FALSE(stays());
}

// A process may be killed between the two steps of a deletion.
TEST_F(SourceDeletionTest, LeftUnderTheHiddenName_IsDeletedByTheNextProcess) {
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  deletion_.configure(config_);
  EXPECT_TRUE(run_until([&] { return deletion_.idle(); }));
  EXPECT_EQ(list_directory(directory_ / "in"), std::vector<std::string>{});
  EXPECT_TRUE(logged(" deleted job=1 source=" + source_));
}

TEST_F(SourceDeletionTest, LeftUnderTheHiddenNameWithoutItsOutput_GetsItsNameBack) {
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  fs::remove(output_);
  deletion_.configure(config_);
  EXPECT_TRUE(stays());
  EXPECT_EQ(read_file(source_), "values");
  EXPECT_TRUE(logged(output_ + " is not there as it was; let its job be done again (weir retry --force 1)"));
}

TEST_F(SourceDeletionTest, LeftUnderTheHiddenNameWhoseNameIsTaken_IsSaid) {
  const std::int64_t id = convert();
  fs::rename(source_, hidden(id));
  fs::remove(output_);
  write_file(source_, "newer");
  deletion_.configure(config_);
  EXPECT_TRUE(stays());
  EXPECT_EQ(read_file(hidden(id)), "values");
  EXPECT_TRUE(logged(hidden(id) + " is the source, which a deletion that was interrupted has left; give it a name"));
}

TEST_F(SourceDeletionTest, AnotherFileUnderTheHiddenName_GetsItsNameBack) {
  const std::int64_t id = convert();
  fs::remove(source_);
  write_file(hidden(id), "what came meanwhile");
  deletion_.configure(config_);
  EXPECT_TRUE(stays());
  EXPECT_EQ(read_file(source_), "what came meanwhile");
  EXPECT_EQ(list_directory(directory_ / "in").size(), 1U);
}

TEST_F(SourceDeletionTest, AnotherFileUnderTheHiddenNameWhoseNameIsTaken_IsSaid) {
  const std::int64_t id = convert();
  write_file(hidden(id), "what came meanwhile");
  write_file(source_, "newer");
  deletion_.configure(config_);
  EXPECT_TRUE(stays());
  EXPECT_EQ(read_file(hidden(id)), "what came meanwhile");
  EXPECT_TRUE(logged(hidden(id) + " is another file, which a deletion that was interrupted has left; give it a name"))
      << read_file(directory_ / "log");
}

TEST_F(SourceDeletionTest, WatchThatKeepsSources_DeletesNothing) {
  config_.watches[0].source = AfterDone::keep;
  delete_done();
  EXPECT_TRUE(deletion_.idle());
}

}  // namespace
}  // namespace weir::source_deletion_test
