#include "daemon/jobs/job_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::job_history_test {
namespace {

using std::chrono::milliseconds;
using Names = std::vector<std::string>;

class JobHistoryTest : public testing::Test {
 protected:
  /// Adds a done job; `there` says whether its source exists.
  void done(const std::string& name, bool there) {
    if (there) write_file(directory_ / name, "x");
    const std::int64_t id = store_.observe("w", directory_ / name, {}, "").job.id;
    store_.enqueue(id);
    store_.start(id);
    store_.finish(id, {});
  }
  Names sources() const {
    Names names;
    for (const Job& job : store_.jobs({}, 0, 1000)) {
      names.push_back(std::filesystem::path(job.source).filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  static constexpr std::int64_t kDay_ms = 86'400'000;
  TemporaryDirectory directory_;
  std::int64_t now_ = 1'800'000'000'000;
  ServiceConfig service_ = [this] {
    ServiceConfig service;
    service.log_file = directory_ / "log";
    return service;
  }();
  boost::asio::io_context io_;
  DiskTurns turns_{io_};
  JobStore store_{directory_ / "weir.db", [this] { return now_; }};
  EventLog log_{service_};
  JobHistory history_{io_, turns_, store_, log_};
};

TEST_F(JobHistoryTest, ForgetsOldDoneJobsWhoseSourceIsGone) {
  done("old_and_there", true);
  done("old_and_gone", false);
  const std::int64_t failed = store_.observe("w", directory_ / "failed", {}, "").job.id;
  store_.quarantine(failed, "bad");
  now_ += 3 * kDay_ms;
  done("young_and_gone", false);
  history_.keep(2.5, {});
  io_.run_for(milliseconds(100));
  EXPECT_EQ(sources(), (Names{"failed", "old_and_there", "young_and_gone"}));
  EXPECT_TRUE(read_file(service_.log_file).ends_with("info history forgotten=1\n")) << read_file(service_.log_file);
}

TEST_F(JobHistoryTest, ForgetsHundredsOfJobsInSeveralPieces) {
  store_.together([&] {
    for (int i = 0; i < 250; ++i) done(cat("gone", i), false);
  });
  done("there", true);
  history_.keep(1, {});
  io_.run_for(milliseconds(100));
  EXPECT_EQ(sources().size(), 251U);
  now_ += kDay_ms;
  history_.keep(1, {});  // a reload starts a new look
  io_.restart();
  io_.run_for(milliseconds(300));
  EXPECT_EQ(sources(), Names{"there"});
}

// While the directory is missing, nothing shows whether the sources are gone.
TEST_F(JobHistoryTest, KeepsJobsWhileTheDirectoryOfTheirWatchIsNotThere) {
  done("in/gone", false);
  now_ += 2 * kDay_ms;
  WatchConfig watch;
  watch.label = "w";
  watch.directory = directory_ / "in";
  history_.keep(1, {&watch, 1});
  io_.run_for(milliseconds(100));
  EXPECT_EQ(sources(), Names{"gone"});
  std::filesystem::create_directory(watch.directory);
  history_.keep(1, {&watch, 1});
  io_.restart();
  io_.run_for(milliseconds(100));
  EXPECT_EQ(sources(), Names{});
}

}  // namespace
}  // namespace weir::job_history_test
