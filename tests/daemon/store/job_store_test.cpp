#include "daemon/store/job_store.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/daemon/support/stored_jobs.h"
#include "tests/support/run_command.h"
#include "tests/support/scoped_mount.h"

namespace weir::job_store_test {
namespace {

using Change = JobStore::Change;
using test::failure;
using test::kIdentity;
using test::StoredJobs;
using test::success;

TEST_F(StoredJobs, RecordsAJobFromDiscoveryToDone) {
  const JobStore::Observation seen = store_->observe("w", "/in/a.raw", kIdentity, "--rate=8");
  EXPECT_EQ(seen.change, Change::created);
  EXPECT_EQ(seen.job.id, 1);
  EXPECT_EQ(seen.job.watch, "w");
  EXPECT_EQ(seen.job.source, "/in/a.raw");
  EXPECT_EQ(seen.job.options, "--rate=8");
  EXPECT_EQ(seen.job.identity, kIdentity);
  EXPECT_EQ(seen.job.state, JobState::discovered);
  EXPECT_EQ(seen.job.discovered_ms, now_);

  now_ += 10;
  EXPECT_TRUE(store_->enqueue(1));
  EXPECT_EQ(job(1).state, JobState::waiting);
  EXPECT_EQ(job(1).queued_ms, now_);
  now_ += 10;
  EXPECT_TRUE(store_->start(1));
  EXPECT_EQ(job(1).state, JobState::running);
  EXPECT_EQ(job(1).started_ms, now_);
  now_ += 10;
  EXPECT_TRUE(store_->finish(1, success()));
  const Job done = job(1);
  EXPECT_EQ(done.state, JobState::done);
  EXPECT_EQ(done.finished_ms, now_);
  EXPECT_EQ(done.changed_ms, now_);
  EXPECT_EQ(done.discovered_ms, now_ - 30);
  EXPECT_EQ(done.attempts, 0);
  EXPECT_EQ(done.result, success());

  open();
  EXPECT_EQ(job(1).result, success());
  EXPECT_EQ(store_->observe("w", "/in/a.raw", kIdentity, "--rate=8").change, Change::none);
  EXPECT_EQ(job(1).state, JobState::done);
}

TEST_F(StoredJobs, StepNotAllowedInTheState_ChangesNothing) {
  const std::int64_t id = observe("/in/a.raw");
  EXPECT_FALSE(store_->start(id));
  EXPECT_FALSE(store_->finish(id, success()));
  EXPECT_FALSE(store_->fail(id, failure(1)));
  EXPECT_FALSE(store_->postpone(id, "no room"));
  EXPECT_FALSE(store_->retry(id));
  EXPECT_EQ(job(id).state, JobState::discovered);
  store_->enqueue(id);
  EXPECT_FALSE(store_->enqueue(id));
  EXPECT_FALSE(store_->retry(id)) << "it is due already";
  store_->start(id);
  EXPECT_FALSE(store_->start(id));
  EXPECT_FALSE(store_->remove(id));
  store_->finish(id, success());
  EXPECT_FALSE(store_->cancel(id));
  EXPECT_FALSE(store_->quarantine(id, "late"));
  EXPECT_EQ(job(id).result, success());
  for (const std::int64_t unknown : {0, 2, -1}) {
    EXPECT_FALSE(store_->job(unknown));
    EXPECT_FALSE(store_->finish(unknown, success()));
    EXPECT_FALSE(store_->fail(unknown, failure(1)));
  }
}

TEST_F(StoredJobs, AChangedSourceIsDiscoveredAgainFromEveryState) {
  const auto end_in = [&](JobState state, std::int64_t id) {
    if (state == JobState::cancelled) store_->cancel(id);
    if (state == JobState::quarantined) store_->quarantine(id, "bad");
    if (state == JobState::discovered || state == JobState::cancelled || state == JobState::quarantined) return;
    store_->enqueue(id);
    if (state == JobState::waiting) return;
    store_->start(id);
    if (state == JobState::done) store_->finish(id, success());
    if (state == JobState::failed) store_->fail(id, failure(4));
  };
  for (std::size_t i = 0; i < kJobStates; ++i) {
    const auto state = static_cast<JobState>(i);
    for (int change = 0; change < 4; ++change) {
      const std::string source = cat("/in/", i, '_', change, ".raw");
      const std::int64_t id = observe(source);
      end_in(state, id);
      ASSERT_EQ(job(id).state, state);
      FileIdentity identity = kIdentity;
      identity.bytes += change == 0 ? 1 : 0;
      identity.mtime_ns -= change == 1 ? 1 : 0;
      identity.inode += change == 2 ? 1 : 0;
      now_ += 5;
      const auto seen = store_->observe("w", source, identity, change == 3 ? "--rate=4" : "--rate=8");
      EXPECT_EQ(seen.change, Change::changed);
      EXPECT_EQ(seen.job.id, id);
      EXPECT_EQ(seen.job.state, JobState::discovered);
      EXPECT_EQ(seen.job.identity, identity);
      EXPECT_EQ(seen.job.attempts, 0);
      EXPECT_EQ(seen.job.discovered_ms, now_);
      EXPECT_EQ(seen.job.queued_ms, 0);
      EXPECT_EQ(seen.job.result, JobResult());
      EXPECT_FALSE(store_->finish(id, success())) << "the late end of the old conversion counts";
    }
  }
}

TEST_F(StoredJobs, RetryDelayDoublesUntilTheLastAttempt) {
  EXPECT_EQ(backoff_ms(1), 5'000);
  EXPECT_EQ(backoff_ms(7), 320'000);
  EXPECT_EQ(backoff_ms(8), 600'000);
  EXPECT_EQ(backoff_ms(1'000'000), 600'000);
  const std::int64_t id = waiting("/in/a.raw");
  for (const std::int64_t delay : {5'000, 10'000, 20'000, 40'000}) {
    ASSERT_TRUE(store_->start(id));
    ASSERT_TRUE(store_->fail(id, failure(1)));
    EXPECT_EQ(job(id).state, JobState::waiting);
    EXPECT_EQ(job(id).result.reason, "it broke");
    EXPECT_EQ(store_->next_due_ms(), delay);
    EXPECT_EQ(candidates(Priority::oldest), Names{});
    now_ += delay - 1;
    EXPECT_EQ(candidates(Priority::oldest), Names{});
    EXPECT_EQ(store_->next_due_ms(), 1);
    now_ += 1;
    EXPECT_EQ(candidates(Priority::oldest), Names{"/in/a.raw"});
    EXPECT_EQ(store_->next_due_ms(), std::nullopt);
  }
  store_->start(id);
  store_->fail(id, failure(139, "killed"));
  EXPECT_EQ(job(id).state, JobState::failed);
  EXPECT_EQ(job(id).attempts, 5);
  EXPECT_TRUE(store_->retry(id));
  EXPECT_EQ(job(id).state, JobState::discovered);
  EXPECT_EQ(job(id).attempts, 0);
  EXPECT_EQ(job(id).result.reason, "");
}

TEST_F(StoredJobs, RetryMakesADelayedJobDueAtOnce) {
  const std::int64_t id = running("/in/a.raw");
  store_->fail(id, failure(1));
  EXPECT_TRUE(store_->retry(id));
  EXPECT_EQ(candidates(Priority::oldest), Names{"/in/a.raw"});
  EXPECT_EQ(job(id).attempts, 0);
}

TEST_F(StoredJobs, ExitCodeDecidesBetweenRetryFailureAndQuarantine) {
  const auto after = [&](int exit_code) {
    const std::int64_t id = running(cat("/in/", exit_code, ".raw"));
    store_->fail(id, failure(exit_code, cat("code ", exit_code)));
    EXPECT_EQ(job(id).attempts, 1);
    EXPECT_EQ(job(id).result.reason, cat("code ", exit_code));
    EXPECT_EQ(job(id).result.log_tail, "a line\nanother\n");
    return job(id).state;
  };
  EXPECT_EQ(after(1), JobState::waiting);
  EXPECT_EQ(after(2), JobState::failed);
  EXPECT_EQ(after(3), JobState::quarantined);
  EXPECT_EQ(after(4), JobState::failed);
  EXPECT_EQ(after(5), JobState::waiting);
  EXPECT_EQ(after(139), JobState::waiting);
}

TEST_F(StoredJobs, PostponedOrInterrupted_CountsNoAttempt) {
  const std::int64_t postponed = running("/in/a.raw");
  EXPECT_TRUE(store_->postpone(postponed, "no room on /out"));
  EXPECT_EQ(job(postponed).state, JobState::waiting);
  EXPECT_EQ(job(postponed).result.reason, "no room on /out");
  const std::int64_t interrupted = running("/in/b.raw");
  open();
  for (const std::int64_t id : {postponed, interrupted}) {
    EXPECT_EQ(job(id).state, JobState::waiting);
    EXPECT_EQ(job(id).attempts, 0);
    EXPECT_EQ(job(id).due_ms, 0);
  }
  EXPECT_EQ(candidates(Priority::oldest), (Names{"/in/a.raw", "/in/b.raw"}));
}

TEST_F(StoredJobs, PostponedWithADelay_WaitsForItAndCountsNoAttempt) {
  const std::int64_t id = running("/in/a.raw");
  EXPECT_TRUE(store_->postpone(id, "the source changed", 2000));
  EXPECT_EQ(job(id).state, JobState::waiting);
  EXPECT_EQ(job(id).attempts, 0);
  EXPECT_EQ(candidates(Priority::oldest), Names{});
  now_ += 2000;
  EXPECT_EQ(candidates(Priority::oldest), Names{"/in/a.raw"});
}

TEST_F(StoredJobs, ClockSetBack_DelaysNoJob) {
  const std::int64_t id = running("/in/a.raw");
  store_->fail(id, failure(1));
  now_ -= std::int64_t{365} * 86'400'000;
  EXPECT_EQ(candidates(Priority::oldest), Names{"/in/a.raw"});
  EXPECT_EQ(store_->next_due_ms(), std::nullopt);
  EXPECT_EQ(store_->queue_age_ms(), 0);
  waiting("/in/b.raw");  // a write, which sets all times back
  EXPECT_EQ(candidates(Priority::oldest).size(), 2U);
}

TEST_F(StoredJobs, DelayLongerThanAnyBackoff_IsKept) {
  const std::int64_t id = running("/in/a.raw");
  ASSERT_TRUE(store_->postpone(id, "the source changed", 3'600'000));
  EXPECT_EQ(candidates(Priority::oldest), Names{});
  EXPECT_EQ(store_->next_due_ms(), 3'600'000);
  now_ += 3'599'999;
  EXPECT_EQ(candidates(Priority::oldest), Names{});
  now_ += 1;
  EXPECT_EQ(candidates(Priority::oldest), Names{"/in/a.raw"});
}

TEST_F(StoredJobs, FailureOfADeviceOrForLackOfMemory_GetsMoreAttempts) {
  for (const int exit_code : {5, 128 + 9}) {
    const std::int64_t id = running(cat("/in/", exit_code, ".raw"));
    std::int64_t waited = 0;
    for (int attempt = 1; attempt < 9; ++attempt) {
      ASSERT_TRUE(store_->fail(id, failure(exit_code)));
      ASSERT_EQ(job(id).state, JobState::waiting) << attempt;
      waited += job(id).due_ms - now_;
      now_ = job(id).due_ms;
      ASSERT_TRUE(store_->start(id));
    }
    EXPECT_EQ(waited, 1'235'000);
    EXPECT_TRUE(store_->fail(id, failure(exit_code)));
    EXPECT_EQ(job(id).state, JobState::failed);
  }
}

TEST_F(StoredJobs, TimesInTheFuture_AreSetBackToNow) {
  now_ += 3'600'000;
  waiting("/in/ahead.raw");
  now_ -= 3'600'000;  // the clock is set back
  waiting("/in/b.raw");
  EXPECT_EQ(job(store_->find("w", "/in/ahead.raw")->id).changed_ms, now_);
  now_ += 1000;
  waiting("/in/c.raw");
  EXPECT_EQ(sources({}).front(), "/in/c.raw");
  now_ += 7'200'000;
  waiting("/in/late.raw");
  now_ -= 7'200'000;
  open();  // the clock is set back while the service is down
  EXPECT_EQ(job(store_->find("w", "/in/late.raw")->id).changed_ms, now_);
}

TEST_F(StoredJobs, OneSourceInTwoWatches_IsTwoJobs) {
  EXPECT_EQ(observe("/in/a.raw", kIdentity, "w"), 1);
  EXPECT_EQ(observe("/in/a.raw", kIdentity, "v"), 2);
  EXPECT_EQ(store_->find("v", "/in/a.raw")->id, 2);
  EXPECT_EQ(store_->find("w", "/in/a.raw")->id, 1);
  EXPECT_FALSE(store_->find("v", "/in/b.raw"));
}

TEST_F(StoredJobs, IdsOfRemovedJobsAreNotReused) {
  const std::int64_t id = observe("/in/a.raw");
  EXPECT_TRUE(store_->remove(id));
  EXPECT_EQ(observe("/in/a.raw"), id + 1);
}

TEST_F(StoredJobs, ForgetOtherWatches_KeepsDoneCancelledAndRunningJobs) {
  const std::int64_t kept = observe("/in/kept.raw", kIdentity, "a");
  std::vector<std::int64_t> ids;
  for (const char* name : {"discovered", "waiting", "failed", "quarantined", "running", "done", "cancelled"}) {
    ids.push_back(observe(std::string("/in/") + name, kIdentity, "b"));
  }
  for (const int at : {1, 2, 4, 5}) store_->enqueue(ids[static_cast<std::size_t>(at)]);
  for (const int at : {2, 4, 5}) store_->start(ids[static_cast<std::size_t>(at)]);
  JobResult wrong_options = success();  // outputs of the first of several volumes
  wrong_options.exit_code = 2;
  store_->fail(ids[2], wrong_options);
  store_->quarantine(ids[3], "bad");
  store_->finish(ids[5], success());
  store_->cancel(ids[6]);

  store_->forget_other_watches({{"a", "/in"}, {"b", "/"}});
  EXPECT_EQ(store_->count({}), 8U);
  store_->forget_other_watches({{"a", "/in"}, {"c", "/in"}});
  EXPECT_EQ(sources({std::nullopt, "b", ""}), (Names{"/in/cancelled", "/in/done", "/in/running"}));
  EXPECT_TRUE(store_->job(kept));
  EXPECT_EQ(job(ids[5]).result.outputs, success().outputs);
  store_->forget_other_watches({});
  EXPECT_FALSE(store_->job(kept));
}

TEST_F(StoredJobs, ForgetOtherWatches_TakesMoreWatchesThanSqliteTakesTerms) {
  observe("/in/7/a.raw", kIdentity, "w7");
  observe("/in/7/a.raw", kIdentity, "w");
  std::vector<JobStore::Watched> watches;
  for (int i = 0; i < 2000; ++i) watches.push_back({cat("w", i), cat("/in/", i)});
  store_->forget_other_watches(watches);
  EXPECT_EQ(sources({std::nullopt, "w7", ""}), Names{"/in/7/a.raw"});
  EXPECT_EQ(sources({std::nullopt, "w", ""}), Names{});
}

TEST_F(StoredJobs, ForgetOtherWatches_ForgetsJobsOfFormerDirectories) {
  observe("/old/a.raw", kIdentity, "w");
  observe("/new/a.raw", kIdentity, "w");
  observe("/newer/a.raw", kIdentity, "w");
  store_->forget_other_watches({{"w", "/new"}});
  EXPECT_EQ(sources({std::nullopt, "w", ""}), Names{"/new/a.raw"});
}

TEST_F(StoredJobs, OverSinceListsJobsDoneOrCancelledBeforeATime) {
  const std::int64_t first = running("/in/first.raw");
  const std::int64_t second = running("/in/second.raw");
  const std::int64_t third = running("/in/third.raw");
  waiting("/in/waiting.raw");
  now_ += 1000;
  store_->finish(first, success());
  store_->cancel(second);
  now_ += 1000;
  store_->finish(third, success());
  const auto over = [&](std::int64_t age_ms, std::int64_t after, std::size_t limit = 10) {
    std::vector<std::int64_t> ids;
    for (const Job& job : store_->over_since(age_ms, after, limit)) ids.push_back(job.id);
    return ids;
  };
  using Ids = std::vector<std::int64_t>;
  EXPECT_EQ(over(2000, 0), Ids{});
  EXPECT_EQ(over(1000, 0), (Ids{first, second}));
  EXPECT_EQ(over(1000, 0, 1), Ids{first});
  EXPECT_EQ(over(1000, first), Ids{second});
  EXPECT_EQ(over(0, first), (Ids{second, third}));
}

TEST_F(StoredJobs, PathsThatAreNotUtf8AreStoredUnchanged) {
  const std::string source = "/in/\xe9t\xe9 '\"\n%.raw";
  const std::int64_t id = waiting(source);
  EXPECT_EQ(store_->find("w", source)->id, id);
  EXPECT_EQ(job(id).source, source);
}

TEST_F(StoredJobs, OnlyTheEndOfALongLogIsKept) {
  const std::int64_t id = running("/in/a.raw");
  JobResult result = failure(1);
  result.log_tail = std::string(5000, 'a') + "end";
  store_->fail(id, result);
  EXPECT_EQ(job(id).result.log_tail, std::string(4093, 'a') + "end");
}

}  // namespace
}  // namespace weir::job_store_test
