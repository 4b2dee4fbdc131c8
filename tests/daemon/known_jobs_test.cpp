// Tests which jobs of the state file are forgotten when a watch begins.
#include "daemon/known_jobs.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tests/support/temporary_directory.h"

namespace weir::known_jobs_test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class KnownJobsTest : public testing::Test {
 protected:
  KnownJobsTest() {
    watch_.label = watch_.directory = directory_ / "in";
    watch_.exclude = {"excluded*"};
    std::filesystem::create_directory(watch_.directory);
  }

  /// Adds a discovered job. All jobs have the same time, as the files of one copy may have.
  std::int64_t observe(const std::string& name) {
    return store_.observe(watch_.label, watch_.directory + '/' + name, {8, 1, 1}, "").job.id;
  }
  std::int64_t waiting(const std::string& name) {
    const std::int64_t id = observe(name);
    EXPECT_TRUE(store_.enqueue(id));
    return id;
  }
  void write(const std::string& name) const { std::ofstream(watch_.directory + '/' + name) << "12345678"; }
  std::uint64_t count() const { return store_.count({}); }

  TemporaryDirectory directory_;
  WatchConfig watch_;
  JobStore store_{directory_ / "weir.db"};
};

TEST_F(KnownJobsTest, ManyJobs_ThoseExcludedAndThoseWhoseFilesAreGone_AreForgotten) {
  std::vector<std::int64_t> kept;
  store_.together([&] {
    for (int i = 0; i < 700; ++i) {
      const std::string name = cat(i % 3 == 0 ? "excluded" : "a", i, "_2x2x2_uint8.raw");
      if (i % 3 != 1) write(name);
      const std::int64_t id = i % 2 == 0 ? observe(name) : waiting(name);
      if (i % 3 == 2) kept.push_back(id);
    }
  });
  KnownJobs jobs(watch_, store_);
  EXPECT_FALSE(jobs.over());
  jobs.step(seconds(20));
  EXPECT_TRUE(jobs.over());
  EXPECT_EQ(count(), kept.size());
  for (const std::int64_t id : kept) EXPECT_TRUE(store_.job(id)) << id;
}

// The service answers requests between the steps.
TEST_F(KnownJobsTest, StepWithoutTime_TakesOnePieceAndTheNextGoesOn) {
  store_.together([&] {
    for (int i = 0; i < 600; ++i) observe(cat("excluded", i, "_2x2x2_uint8.raw"));
  });
  KnownJobs jobs(watch_, store_);
  std::vector<std::uint64_t> left;
  for (int i = 0; i < 3; ++i) {
    jobs.step(milliseconds(0));
    left.push_back(count());
  }
  EXPECT_EQ(left, (std::vector<std::uint64_t>{350, 100, 0}));
}

TEST_F(KnownJobsTest, JobsThatAreOver_AreKept) {
  for (const bool done : {true, false}) {
    const std::int64_t id = waiting(cat("excluded", done ? "1" : "2", "_2x2x2_uint8.raw"));
    ASSERT_TRUE(done ? store_.start(id) && store_.finish(id, {}) : store_.cancel(id));
  }
  KnownJobs jobs(watch_, store_);
  jobs.step(seconds(20));
  EXPECT_TRUE(jobs.over());
  EXPECT_EQ(count(), 2U);
}

TEST_F(KnownJobsTest, JobsOfAnotherWatch_AreKept) {
  store_.observe("another", watch_.directory + "/excluded_2x2x2_uint8.raw", {8, 1, 1}, "");
  KnownJobs jobs(watch_, store_);
  jobs.step(seconds(20));
  EXPECT_EQ(count(), 1U);
}

TEST_F(KnownJobsTest, DirectoryThatIsNotThere_ForgetsOnlyWhatTheConfigurationNoLongerTakes) {
  std::filesystem::remove(watch_.directory);
  const std::int64_t id = observe("a_2x2x2_uint8.raw");
  observe("excluded_2x2x2_uint8.raw");
  KnownJobs jobs(watch_, store_);
  jobs.step(seconds(20));
  EXPECT_TRUE(jobs.over());
  EXPECT_EQ(count(), 1U);
  EXPECT_TRUE(store_.job(id));
  std::filesystem::create_directory(watch_.directory);
  jobs.begin_anew();
  EXPECT_FALSE(jobs.over());
  jobs.step(seconds(20));
  EXPECT_EQ(count(), 0U);
}

// If the state file cannot be written, the transaction and its removals are rolled back.
TEST_F(KnownJobsTest, StepThatWasTakenBack_IsDoneAgain) {
  observe("excluded_2x2x2_uint8.raw");
  observe("gone_2x2x2_uint8.raw");
  KnownJobs jobs(watch_, store_);
  const KnownJobs::Progress before = jobs.progress();
  EXPECT_ANY_THROW(store_.together([&] {
    jobs.step(seconds(20));
    throw 1;
  }));
  EXPECT_EQ(count(), 2U);
  jobs.go_back_to(before);
  jobs.step(seconds(20));
  EXPECT_EQ(count(), 0U);
}

}  // namespace
}  // namespace weir::known_jobs_test
