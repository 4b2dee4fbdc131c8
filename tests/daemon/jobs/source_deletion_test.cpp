// Tests when sources are deleted. interrupted_deletion_test.cpp tests interrupted deletions.
#include "daemon/jobs/source_deletion.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <sys/mman.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/io/descriptor.h"
#include "tests/daemon/support/deleting_watch.h"
#include "tests/daemon/support/stepped_file_system.h"
#include "tests/support/file_tick.h"

namespace weir::source_deletion_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

using SourceDeletionTest = DeletingWatch;

// Returns a file system in which `writer` calls open(SOURCE) before the first rename and waits for the lease.
std::unique_ptr<FileSystem> opened_before_rename(std::thread& writer,
                                                 const std::function<void(const std::string&)>& open) {
  auto files = std::make_unique<SteppedFileSystem>();
  files->before_rename = [&writer, open](const std::string& from) {
    if (writer.joinable()) return;
    writer = std::thread([open, from] { open(from); });
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (read_file("/proc/locks").find("BREAKING") == std::string::npos && std::chrono::steady_clock::now() < end) {
      std::this_thread::yield();
    }
  };
  return files;
}

// The kernel makes a program that opens the source for writing wait while the service holds its lease.
TEST_F(SourceDeletionTest, OpenedForWritingWhileItIsLookedAt_StaysWithWhatIsWritten) {
  std::thread writer;
  auto files = opened_before_rename(
      writer, [](const std::string& source) { std::ofstream(source, std::ios::app) << " and more"; });
  SourceDeletion deletion(io_, store_, log_, {}, std::move(files));
  deletion.configure(config_);
  deletion.done(convert());
  EXPECT_TRUE(run_until([&] { return deletion.idle(); }));
  ASSERT_TRUE(writer.joinable());
  writer.join();
  EXPECT_TRUE(logged("a program has it open for writing; tried again later"));
  EXPECT_EQ(read_file(source_), "values and more");
  EXPECT_EQ(list_directory(directory_ / "in").size(), 1U);
}

// The service's own renames, to the hidden name and back, do not make the source another file.
TEST_F(SourceDeletionTest, OpenedWhileItIsLookedAtAndNotWritten_IsDeletedLater) {
  std::thread writer;
  auto files = opened_before_rename(
      writer, [](const std::string& source) { const Descriptor opened(::open(source.c_str(), O_WRONLY | O_CLOEXEC)); });
  SourceDeletion deletion(io_, store_, log_, {}, std::move(files));
  pass_file_tick();  // the renames change the file's status time
  deletion.configure(config_);
  deletion.done(convert());
  EXPECT_TRUE(run_until([&] { return deletion.idle(); }));
  ASSERT_TRUE(writer.joinable());
  writer.join();
  EXPECT_TRUE(logged("a program has it open for writing; tried again later"));
  EXPECT_FALSE(fs::exists(source_));
  EXPECT_TRUE(logged(" deleted job=1 source=" + source_));
}

// A disk or a server may refuse an operation once and permit it later. The temporary hidden name does not make the
// source another file.
TEST_F(SourceDeletionTest, RemovalThatFails_IsSaidOnceAndTriedAgain) {
  auto files = std::make_unique<SteppedFileSystem>();
  int failures = 3;
  files->before_remove = [&failures](const std::string& path) {
    if (failures-- > 0) throw io_error(path, "remove", EIO);
  };
  SourceDeletion deletion(io_, store_, log_, {}, std::move(files));
  pass_file_tick();  // the renames change the file's status time
  deletion.configure(config_);
  const std::int64_t id = convert();
  deletion.done(id);
  EXPECT_TRUE(run_until([&] { return deletion.idle(); }));
  EXPECT_FALSE(fs::exists(source_));
  EXPECT_FALSE(fs::exists(hidden(id)));
  EXPECT_TRUE(logged(" deleted job=1 source=" + source_));
  const std::string log = read_file(directory_ / "log");
  const std::string reason =
      hidden(id) + ": cannot remove: Input/output error; check the disk or the file server; tried again later";
  EXPECT_NE(log.find(reason), std::string::npos) << log;
  EXPECT_EQ(log.find("not-deleted"), log.rfind("not-deleted")) << log;
}

TEST_F(SourceDeletionTest, SourceIsDeletedAfterTheDelay) {
  config_.watches[0].delete_after_s = 0.3;
  const auto begin = std::chrono::steady_clock::now();
  delete_done();
  EXPECT_TRUE(run_until([&] { return !fs::exists(source_); }));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(300));
  EXPECT_TRUE(logged(" deleted job=1 source=" + source_ + " in_use=no"));
}

TEST_F(SourceDeletionTest, MarkerIsDeletedWithItsSource) {
  config_.watches[0].complete = Completion::marker;
  write_file(source_ + ".done", "");
  delete_done();
  EXPECT_FALSE(stays());
  EXPECT_FALSE(fs::exists(source_ + ".done"));
}

// A process may be killed between any two steps: no marker may be left without its source.
TEST_F(SourceDeletionTest, Marker_IsDeletedBeforeItsSource) {
  config_.watches[0].complete = Completion::marker;
  write_file(source_ + ".done", "");
  const std::int64_t id = convert();
  auto files = std::make_unique<SteppedFileSystem>();
  std::vector<std::string> removed;
  files->before_remove = [&](const std::string& path) {
    EXPECT_TRUE(fs::exists(hidden(id))) << path;
    EXPECT_FALSE(fs::exists(source_)) << path;
    EXPECT_EQ(fs::exists(source_ + ".done"), removed.empty()) << path;
    removed.push_back(path);
  };
  SourceDeletion deletion(io_, store_, log_, {}, std::move(files));
  deletion.configure(config_);
  deletion.done(id);
  EXPECT_TRUE(run_until([&] { return deletion.idle(); }));
  EXPECT_EQ(removed, (std::vector<std::string>{source_ + ".done", hidden(id)}));
  EXPECT_EQ(list_directory(directory_ / "in"), std::vector<std::string>{});
}

TEST_F(SourceDeletionTest, RemovalThatFailsBehindTheMarker_MakesTheMarkerAgain) {
  config_.watches[0].complete = Completion::marker;
  write_file(source_ + ".done", "");
  const std::int64_t id = convert();
  auto files = std::make_unique<SteppedFileSystem>();
  bool fails = true;
  files->before_remove = [&](const std::string& path) {
    if (fails && path == hidden(id)) throw io_error(path, "remove", EIO);
  };
  SourceDeletion deletion(io_, store_, log_, {}, std::move(files));
  deletion.configure(config_);
  deletion.done(id);
  ASSERT_TRUE(run_until([&] { return logged(" not-deleted job=1 "); }));
  EXPECT_TRUE(fs::exists(source_));
  EXPECT_TRUE(fs::exists(source_ + ".done"));
  fails = false;
  EXPECT_TRUE(run_until([&] { return deletion.idle(); }));
  EXPECT_EQ(list_directory(directory_ / "in"), std::vector<std::string>{});
}

// The directory may be away for a moment, for example while it is remounted.
TEST_F(SourceDeletionTest, DirectoryThatIsAway_IsWaitedForAndSaidOnce) {
  deletion_.configure(config_);
  deletion_.done(convert());
  fs::rename(directory_ / "in", directory_ / "away");
  ASSERT_TRUE(run_until([&] { return logged(" not-deleted watch="); }));
  EXPECT_TRUE(logged(" reason=\"" + (directory_ / "in") + " is not there; tried again once it is\""));
  EXPECT_FALSE(run_until([&] { return deletion_.idle(); }, milliseconds(500)));  // it is checked again and again
  const std::string log = read_file(directory_ / "log");
  EXPECT_EQ(log.find("not-deleted"), log.rfind("not-deleted")) << log;
  fs::rename(directory_ / "away", directory_ / "in");
  EXPECT_FALSE(stays());
  EXPECT_TRUE(logged(" deleted job=1 source=" + source_));
}

// A link stands for the mount point. While nothing is mounted there, the outputs are out of sight, too.
TEST_F(SourceDeletionTest, OutputMountWithoutAFileSystem_IsWaitedFor) {
  const std::string mount = directory_ / "mount";
  fs::create_directory_symlink(directory_.path(), mount);
  config_.watches[0].output_mount = mount;
  delete_done();
  fs::rename(directory_ / "out", directory_ / "away");
  ASSERT_TRUE(run_until([&] { return logged(" not-deleted watch="); }));
  EXPECT_TRUE(logged(" reason=\"no file system is mounted at " + mount + "; tried again once one is\""));
  EXPECT_FALSE(run_until([&] { return deletion_.idle(); }, milliseconds(300)));
  fs::rename(directory_ / "away", directory_ / "out");
  fs::remove(mount);
  fs::create_directory_symlink("/proc", mount);
  EXPECT_FALSE(stays());
  EXPECT_TRUE(logged(" deleted job=1 source=" + source_));
}

TEST_F(SourceDeletionTest, OpenForWriting_WaitsForTheClose) {
  Descriptor writer(::open(source_.c_str(), O_WRONLY | O_CLOEXEC));
  delete_done();
  ASSERT_TRUE(run_until([&] { return logged("a program has it open for writing; tried again later"); }));
  EXPECT_TRUE(fs::exists(source_));
  writer.reset();
  EXPECT_FALSE(stays());
}

// numpy.memmap maps files this way: nothing is written or closed, and no time changes, until the memory is released.
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
  EXPECT_TRUE(logged("it was replaced, or its name, rights, owner or links were changed, after " +
                     sidecar_path(output_) + " was written; let its job be done again (weir retry --force 1)"));
}

TEST_F(SourceDeletionTest, OutputThatWasWrittenToSinceItWasCertified_KeepsItsSource) {
  config_.watches[0].delete_after_s = 1;  // longer than the next calls take
  delete_done();
  const auto bytes = fs::file_size(output_);
  pass_file_tick();
  fs::resize_file(output_, 0);
  fs::resize_file(output_, bytes);
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged(output_ + " was written to after its certificate; let its job be done again (weir retry --force "
                               "1)"));
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
  fs::create_directory(watch.directory);
  deletion_.configure(config_);
  EXPECT_TRUE(stays()) << "another directory";
}

TEST_F(SourceDeletionTest, WhileJobsAreHeld_NothingIsDeleted) {
  held_ = true;
  delete_done();
  EXPECT_FALSE(run_until([&] { return !fs::exists(source_); }, milliseconds(300)));
  EXPECT_FALSE(deletion_.idle());
}

// logrotate makes the service reload: if this restarted the delay, a delay of a week would never end.
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

// A source whose hidden name is taken does not hold up the sources behind it.
TEST_F(SourceDeletionTest, WhatCannotBeDeleted_IsSaidAndTheNextOneGoes) {
  const std::int64_t id = convert();
  write_file(hidden(id), "left by another deletion");
  const std::string first = std::exchange(source_, directory_ / "in/b_1x2x3_uint8.raw");
  output_ = directory_ / "out/b.nvdb";
  write_file(source_, "others");
  pass_file_tick();
  write_output("");
  convert();
  deletion_.configure(config_);
  EXPECT_FALSE(stays());
  EXPECT_TRUE(fs::exists(first));
  EXPECT_EQ(read_file(hidden(id)), "left by another deletion");
}

TEST_F(SourceDeletionTest, MarkerThatCannotBeRemoved_IsSaidOnceAndKeepsItsSource) {
  config_.watches[0].complete = Completion::marker;
  fs::create_directories(source_ + ".done/not empty");
  delete_done();
  ASSERT_TRUE(run_until([&] { return logged(" marker-stays job=1 reason="); }));
  run_until([] { return false; }, milliseconds(500));  // tried again
  EXPECT_TRUE(logged("; its source stays, tried again later"));
  EXPECT_TRUE(fs::exists(source_));
  const std::string log = read_file(directory_ / "log");
  EXPECT_EQ(log.find("marker-stays"), log.rfind("marker-stays")) << log;
  fs::remove_all(source_ + ".done");
  EXPECT_FALSE(stays());
}

// If the hierarchy has no chunk yet, its certificate may name a single file.
TEST_F(SourceDeletionTest, HeadOfADirectory_Stays) {
  config_.watches[0].recursive = true;
  fs::create_directory(directory_ / "in/a.zarr");
  for (const char* head : {"zarr.json", ".zgroup", ".zarray"}) {
    source_ = directory_ / "in/a.zarr/" + head;
    write_file(source_, "values");
    pass_file_tick();
    write_output("");
    delete_done();
    EXPECT_TRUE(stays()) << head;
    EXPECT_TRUE(logged(source_ + " reason=\"it stands for a directory, whose files are never deleted\"")) << head;
  }
}

// A deletion would remove the link, and the target would still take the disk space.
TEST_F(SourceDeletionTest, SymbolicLink_StaysWithItsTarget) {
  const std::string target = directory_ / "in/.target";
  fs::rename(source_, target);
  fs::create_symlink(target, source_);
  pass_file_tick();
  write_output("");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(fs::is_symlink(source_));
  EXPECT_EQ(read_file(target), "values");
  EXPECT_TRUE(logged(source_ + " reason=\"it is a symbolic link, whose target would stay\""));
  EXPECT_FALSE(logged(" deleted "));
}

// For example, the source is moved to another disk at this moment and a link put in its place.
TEST_F(SourceDeletionTest, ReplacedByALinkToItWhileItIsDeleted_GetsItsNameBack) {
  const std::string target = directory_ / "in/.target";
  auto files = std::make_unique<SteppedFileSystem>();
  files->before_rename = [target](const std::string& from) {
    if (fs::exists(target)) return;
    fs::rename(from, target);
    fs::create_symlink(target, from);
  };
  SourceDeletion deletion(io_, store_, log_, {}, std::move(files));
  deletion.configure(config_);
  deletion.done(convert());
  EXPECT_TRUE(run_until([&] { return deletion.idle(); }));
  EXPECT_TRUE(fs::is_symlink(source_));
  EXPECT_EQ(read_file(target), "values");
  EXPECT_FALSE(logged(" deleted "));
}

TEST_F(SourceDeletionTest, DoneByAnEarlierProcess_IsDeleted) {
  convert();
  deletion_.configure(config_);
  EXPECT_FALSE(deletion_.idle());
  EXPECT_FALSE(stays());
}

TEST_F(SourceDeletionTest, WatchThatKeepsSources_DeletesNothing) {
  config_.watches[0].source = AfterDone::keep;
  delete_done();
  EXPECT_TRUE(deletion_.idle());
}

}  // namespace
}  // namespace weir::source_deletion_test
