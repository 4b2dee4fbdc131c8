#include "daemon/store/job_store.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/daemon/support/stored_jobs.h"
#include "tests/support/run_command.h"
#include "tests/support/scoped_mount.h"

namespace weir::job_retry_test {
namespace {

using Change = JobStore::Change;
using test::failure;
using test::kIdentity;
using test::StoredJobs;
using test::success;

TEST_F(StoredJobs, RetryResetsFailedAndQuarantinedJobs) {
  JobResult wrong_options;
  wrong_options.exit_code = 2;
  const std::int64_t failed = running("/in/failed.raw");
  store_->fail(failed, wrong_options);
  const std::int64_t bad = observe("/in/bad.raw");
  store_->quarantine(bad, "bad");
  const std::int64_t done = running("/in/done.raw");
  store_->finish(done, success());
  EXPECT_EQ(store_->with_problems(""),
            (std::vector<JobStore::Problem>{{failed, "w", "/in/failed.raw"}, {bad, "w", "/in/bad.raw"}}));
  for (const std::int64_t id : {failed, bad}) EXPECT_TRUE(store_->retry(id));
  for (const std::int64_t id : {failed, bad}) {
    EXPECT_EQ(job(id).state, JobState::discovered);
    EXPECT_EQ(job(id).attempts, 0);
    EXPECT_EQ(job(id).result.reason, "");
  }
  EXPECT_EQ(job(done).state, JobState::done);
}

TEST_F(StoredJobs, Hasten_FailedJob_GetsOneMoreAttempt) {
  const std::int64_t id = running("/in/a.raw");
  store_->fail(id, failure(5));
  EXPECT_TRUE(store_->hasten(id));
  EXPECT_EQ(job(id).state, JobState::waiting);
  EXPECT_EQ(job(id).due_ms, 0);
  EXPECT_EQ(job(id).attempts, 1);
  EXPECT_FALSE(store_->hasten(id)) << "it is due already";
  for (int attempt = 2; attempt <= most_attempts(5); ++attempt) {
    EXPECT_TRUE(store_->start(id));
    store_->fail(id, failure(5));
    now_ += 3'600'000;
  }
  EXPECT_EQ(job(id).state, JobState::failed);
  EXPECT_TRUE(store_->hasten(id));
  EXPECT_EQ(job(id).state, JobState::discovered);
  store_->enqueue(id);
  store_->start(id);
  store_->fail(id, failure(5));
  EXPECT_EQ(job(id).state, JobState::failed) << "for good, until it is retried";
  const std::int64_t bad = running("/in/b.raw");
  store_->fail(bad, failure(3));
  EXPECT_FALSE(store_->hasten(bad));
}

TEST_F(StoredJobs, StartOfAnotherAttempt_ClearsTheReasonOfTheLast) {
  const std::int64_t id = running("/in/a.raw");
  store_->fail(id, failure(5, "no such server"));
  EXPECT_EQ(job(id).result.reason, "no such server") << "why it waits";
  now_ += 3'600'000;
  EXPECT_TRUE(store_->start(id));
  EXPECT_EQ(job(id).state, JobState::running);
  EXPECT_EQ(job(id).result.reason, "");
  store_->fail(id, failure(5, "no such server"));
  EXPECT_EQ(job(id).result.reason, "no such server");
  EXPECT_EQ(job(id).attempts, 2);
}

TEST_F(StoredJobs, ForcedRetry_StaysForcedUntilDoneOrCancelled) {
  const std::int64_t id = running("/in/a.raw");
  store_->finish(id, success());
  EXPECT_TRUE(store_->retry(id, true));
  store_->enqueue(id);
  store_->start(id);
  store_->fail(id, failure(5));
  EXPECT_TRUE(job(id).forced);
  now_ += 3'600'000;
  store_->start(id);
  store_->finish(id, success());
  EXPECT_FALSE(job(id).forced);
  EXPECT_TRUE(store_->retry(id, true));
  EXPECT_TRUE(store_->cancel(id));
  EXPECT_FALSE(job(id).forced);
}

TEST_F(StoredJobs, RetryFailedIo_RetriesOnlyJobsWithExitCode5) {
  JobResult device;
  device.exit_code = 5;
  const std::int64_t io = running("/in/io.raw");
  for (int attempt = 1; attempt < most_attempts(5); ++attempt) {
    store_->fail(io, device);
    now_ += 24 * 3'600'000;
    store_->start(io);
  }
  store_->fail(io, device);
  ASSERT_EQ(job(io).state, JobState::failed);
  JobResult wrong_options;
  wrong_options.exit_code = 2;
  const std::int64_t usage = running("/in/usage.raw");
  store_->fail(usage, wrong_options);
  store_->retry_failed_io();
  EXPECT_EQ(job(io).state, JobState::discovered);
  EXPECT_EQ(job(usage).state, JobState::failed);
}

}  // namespace
}  // namespace weir::job_retry_test
