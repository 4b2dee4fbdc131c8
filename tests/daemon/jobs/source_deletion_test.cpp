#include "daemon/jobs/source_deletion.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "daemon/jobs/conversion_task.h"
#include "daemon/store/file_identity.h"
#include "daemon/watch/file_writers.h"
#include "format/io/descriptor.h"
#include "format/sidecar/sidecar.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::source_deletion_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

class SourceDeletionTest : public testing::Test {
 protected:
  SourceDeletionTest() {
    fs::create_directory(directory_ / "in");
    fs::create_directory(directory_ / "out");
    WatchConfig watch;
    watch.label = "w";
    watch.directory = directory_ / "in";
    watch.source = AfterDone::delete_after_verify;
    watch.delete_after_s = 0.05;
    config_.watches = {watch};
    write_file(source_, "values");
    std::this_thread::sleep_for(milliseconds(20));  // longer than a tick of the clock of files
    write_output("");
  }

  void write_output(const std::string& more) const {
    write_file(output_, "volume");
    write_file(sidecar_path(output_), "{\"source\": {\"path\": \"" + source_ + "\", \"bytes\": 6, \"mtime\": \"" +
                                          utc_text(identify(source_)->mtime_ns) + "\"" + more + "}}");
  }
  /// The job of the source, done.
  std::int64_t convert() {
    const std::int64_t id = store_.observe("w", source_, *identify(source_), options_text(config_.watches[0])).job.id;
    store_.enqueue(id);
    store_.start(id);
    JobResult result;
    JobOutput output;
    output.path = output_;
    output.bytes = 6;
    result.outputs = {output};
    store_.finish(id, result);
    return id;
  }
  void delete_done() {
    deletion_.configure(config_);
    deletion_.done(convert());
  }
  bool run_until(const std::function<bool()>& holds, milliseconds patience = std::chrono::seconds(20)) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!holds()) {
      if (std::chrono::steady_clock::now() > end) return false;
      io_.restart();
      io_.run_for(milliseconds(5));
    }
    return true;
  }
  bool stays() {
    EXPECT_TRUE(run_until([&] { return deletion_.idle(); }));
    return fs::exists(source_);
  }
  std::string hidden(std::int64_t id) const { return directory_ / "in/.weir-delete-" + std::to_string(id); }
  bool logged(const std::string& text) const { return read_file(directory_ / "log").find(text) != std::string::npos; }

  TemporaryDirectory directory_;
  std::string source_ = directory_ / "in/a_1x2x3_uint8.raw";
  std::string output_ = directory_ / "out/a.nvdb";
  DaemonConfig config_;
  boost::asio::io_context io_;
  JobStore store_{directory_ / "weir.db"};
  ServiceConfig service_ = [this] {
    ServiceConfig service;
    service.log_file = directory_ / "log";
    return service;
  }();
  EventLog log_{service_};
  SourceDeletion deletion_{io_, store_, log_};
};

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

TEST_F(SourceDeletionTest, WithAnotherSourcesCertificate_Stays) {
  write_file(sidecar_path(output_), R"({"source": {"path": "/other.raw", "bytes": 6}})");
  delete_done();
  EXPECT_TRUE(stays());
}

TEST_F(SourceDeletionTest, LosslessFileOfRoundedValues_Stays) {
  write_output(R"(}, "error": {"lossless": true}, "conversion_loss": {"inexact": 2, "overflow": 0)");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged("2 values were rounded to float32, so the output is not lossless"));
}

TEST_F(SourceDeletionTest, ValuesThatBecameInfinite_Stay) {
  write_output(R"(}, "error": {"lossless": false}, "conversion_loss": {"inexact": 0, "overflow": 1)");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged("1 value is infinite in float32"));
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

TEST_F(SourceDeletionTest, WithoutItsOutput_Stays) {
  delete_done();
  fs::remove(output_);
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged(output_ + " is not there as it was"));
}

TEST_F(SourceDeletionTest, WithoutACertificate_Stays) {
  write_file(sidecar_path(output_), "{");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged(sidecar_path(output_) + " cannot be read"));
}

TEST_F(SourceDeletionTest, ValuesInSeveralFiles_Stay) {
  write_output(", \"files_digest\": \"0123456789abcdef\"");
  delete_done();
  EXPECT_TRUE(stays());
  EXPECT_TRUE(logged("its values lie in several files, which other headers may name"));
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

// The other way to find them, where no lease is to be had.
TEST(FileWritersTest, AnotherUsersFile_IsLookedUpAmongTheProcesses) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.raw";
  write_file(path, "values");
  if (::geteuid() != 0) GTEST_SKIP() << "only root has other users' files";
  ASSERT_EQ(::chmod(directory.path().c_str(), 0755), 0);
  ASSERT_EQ(::chmod(path.c_str(), 0666), 0);
  ASSERT_EQ(::seteuid(65534), 0);
  EXPECT_FALSE(FileWriters(path).some());
  EXPECT_FALSE(FileWriters(path).known());
  ASSERT_EQ(::seteuid(0), 0);
  Descriptor writer(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  EXPECT_TRUE(FileWriters(path).some());
}

}  // namespace
}  // namespace weir::source_deletion_test
