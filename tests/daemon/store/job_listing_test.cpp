// Tests what the store lists, finds, groups and counts.
#include <gtest/gtest.h>

#include "format/base/text.h"
#include "tests/daemon/support/stored_jobs.h"

namespace weir::job_listing_test {
namespace {

using test::failure;
using test::kIdentity;
using test::success;

class JobListing : public test::StoredJobs {};

TEST_F(JobListing, CandidatesAreOrderedByTheTimeOfTheirSources) {
  waiting("/in/b.raw", {1, 200, 1});
  waiting("/in/a.raw", {1, 300, 1});
  waiting("/in/c.raw", {1, 100, 1});
  waiting("/in/d.raw", {1, 200, 1});
  waiting("/in/other.raw", {1, 1, 1}, "another watch");
  observe("/in/e.raw", {1, 400, 1});
  EXPECT_EQ(candidates(Priority::oldest), (Names{"/in/c.raw", "/in/b.raw", "/in/d.raw", "/in/a.raw"}));
  EXPECT_EQ(candidates(Priority::newest), (Names{"/in/a.raw", "/in/d.raw", "/in/b.raw", "/in/c.raw"}));
  EXPECT_EQ(candidates(Priority::newest, 1), Names{"/in/a.raw"});
}

TEST_F(JobListing, ListsFiltersAndCountsJobs) {
  waiting("/in/a.raw");
  now_ += 1000;
  waiting("/in/b.raw", kIdentity, "v");
  now_ += 1000;
  const std::int64_t done = running("/in/C_100%.h5");
  store_->finish(done, success());
  EXPECT_EQ(sources({}), (Names{"/in/C_100%.h5", "/in/b.raw", "/in/a.raw"}));
  EXPECT_EQ(sources({}, 1, 1), Names{"/in/b.raw"});
  EXPECT_EQ(sources({}, 3), Names{});
  EXPECT_EQ(sources({JobState::waiting, "", ""}), (Names{"/in/a.raw", "/in/b.raw"}));
  EXPECT_EQ(sources({JobState::waiting, "v", ""}), Names{"/in/b.raw"});
  EXPECT_EQ(sources({{}, "", "c_100%"}), Names{"/in/C_100%.h5"});
  EXPECT_EQ(sources({{}, "", "c_1000"}), Names{});
  EXPECT_EQ(store_->count({}), 3U);
  EXPECT_EQ(store_->count({JobState::waiting, "w", "RAW"}), 1U);
  JobCounts w{};
  w[static_cast<std::size_t>(JobState::waiting)] = 1;
  w[static_cast<std::size_t>(JobState::done)] = 1;
  JobCounts v{};
  v[static_cast<std::size_t>(JobState::waiting)] = 1;
  EXPECT_EQ(store_->counts(), (std::map<std::string, JobCounts>{{"v", v}, {"w", w}}));
  EXPECT_EQ(store_->queue_age_ms(), 2000);
}

TEST_F(JobListing, ListsSourcesInPieces) {
  const std::int64_t late = waiting("/in/late.raw", {1, 200, 1});
  const std::int64_t one = waiting("/in/one.raw", {1, 100, 1});
  const std::int64_t two = waiting("/in/two.raw", {1, 100, 1});  // has the same time
  const std::int64_t early = waiting("/in/early.raw", {1, -5, 1});
  waiting("/in/other.raw", {1, 100, 1}, "another watch");
  observe("/in/discovered.raw", {1, 100, 1});
  using Sources = std::vector<JobStore::Source>;
  const Sources first = store_->sources("w", JobState::waiting, {}, 2);
  EXPECT_EQ(first, (Sources{{early, "/in/early.raw", -5}, {one, "/in/one.raw", 100}}));
  const Sources second = store_->sources("w", JobState::waiting, {100, one}, 2);
  EXPECT_EQ(second, (Sources{{two, "/in/two.raw", 100}, {late, "/in/late.raw", 200}}));
  EXPECT_EQ(store_->sources("w", JobState::waiting, {200, late}, 2), Sources{});
}

TEST_F(JobListing, ListsTheIdsOfDoneJobsWithoutTheirThumbnails) {
  std::vector<std::int64_t> ids;
  for (const bool rendering : {true, false, true}) {
    ids.push_back(running(cat("/in/", ids.size(), ".raw")));
    ASSERT_TRUE(store_->finish(ids.back(), success(), rendering));
  }
  EXPECT_EQ(store_->unrendered(), (std::vector<std::int64_t>{ids[0], ids[2]}));
  store_->finish_rendering(ids[0], {});
  EXPECT_EQ(store_->unrendered(), std::vector<std::int64_t>{ids[2]});
}

TEST_F(JobListing, SearchMatchesTheReason) {
  store_->fail(running("/in/a.raw"), failure(3, "/in/a.raw: is CUT"));
  EXPECT_EQ(sources({{}, "", "is cut"}), Names{"/in/a.raw"});
  EXPECT_EQ(sources({{}, "", "100%"}), Names{});
}

TEST_F(JobListing, ListsJobsInTheRequestedOrder) {
  FileIdentity small = kIdentity;
  small.bytes = 1;
  waiting("/in/b.raw");
  now_ += 1000;
  waiting("/in/c.raw", small);
  now_ += 1000;
  store_->finish(running("/in/a.raw", "v"), success());
  const auto listed = [&](JobOrderKey key, bool descending) {
    Names names;
    for (const Job& job : store_->jobs({}, 0, 10, JobOrder{key, descending})) names.push_back(job.source);
    return names;
  };
  EXPECT_EQ(listed(JobOrderKey::source, false), (Names{"/in/a.raw", "/in/b.raw", "/in/c.raw"}));
  EXPECT_EQ(listed(JobOrderKey::source, true), (Names{"/in/c.raw", "/in/b.raw", "/in/a.raw"}));
  EXPECT_EQ(listed(JobOrderKey::bytes, false), (Names{"/in/c.raw", "/in/b.raw", "/in/a.raw"}));
  EXPECT_EQ(listed(JobOrderKey::seconds, true).front(), "/in/a.raw");
  EXPECT_EQ(listed(JobOrderKey::watch, false).front(), "/in/a.raw");
  EXPECT_EQ(listed(JobOrderKey::state, false).front(), "/in/a.raw");
  EXPECT_EQ(listed(JobOrderKey::changed, false), (Names{"/in/b.raw", "/in/c.raw", "/in/a.raw"}));
  EXPECT_EQ(listed(JobOrderKey::discovered, true), (Names{"/in/a.raw", "/in/c.raw", "/in/b.raw"}));
}

TEST_F(JobListing, JobsWithTheSameProblemAreOneGroup) {
  for (const int i : {1, 2, 3}) {
    const std::string source = cat("/in/", i, ".raw");
    store_->fail(running(source), failure(3, cat(source, ": has ", 100 * i, " bytes and should have 512")));
    now_ += 1000;
  }
  store_->fail(running("/in/4.raw"), failure(2, "/in/4.raw: is strange"));
  const std::vector<JobProblem> problems = store_->problems(10);
  ASSERT_EQ(problems.size(), 2U);
  EXPECT_EQ(problems[0].key, "is strange");
  EXPECT_EQ(problems[0].count, 1U);
  EXPECT_EQ(problems[0].newest.state, JobState::failed);
  EXPECT_EQ(problems[1].key, "has # bytes and should have #");
  EXPECT_EQ(problems[1].count, 3U);
  EXPECT_EQ(problems[1].newest.source, "/in/3.raw");
  EXPECT_EQ(store_->problems(1).size(), 1U);
  EXPECT_EQ(sources({{}, "", "", problems[1].key}), (Names{"/in/3.raw", "/in/2.raw", "/in/1.raw"}));
  EXPECT_EQ(store_->with_problems("").size(), 4U);
  const std::vector<JobStore::Problem> alike = store_->with_problems(problems[1].key);
  ASSERT_EQ(alike.size(), 3U);
  for (const JobStore::Problem& job : alike) EXPECT_TRUE(store_->retry_problem(job.id));
  EXPECT_EQ(sources({JobState::failed, ""}), Names{"/in/4.raw"});
  EXPECT_EQ(sources({JobState::quarantined, ""}), Names{});
  EXPECT_EQ(store_->problems(10).size(), 1U);
}

TEST_F(JobListing, SumsWaitingBytesByWatch) {
  EXPECT_TRUE(store_->waiting_bytes().empty());
  waiting("/in/a.raw");
  waiting("/in/b.raw");
  waiting("/in/c.raw", kIdentity, "v");
  running("/in/d.raw");
  EXPECT_EQ(store_->waiting_bytes(),
            (std::map<std::string, std::uint64_t>{{"w", 2 * kIdentity.bytes}, {"v", kIdentity.bytes}}));
}

}  // namespace
}  // namespace weir::job_listing_test
