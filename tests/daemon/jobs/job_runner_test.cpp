// Tests jobs from the state file to their results, with the real `weir`.
#include "daemon/jobs/job_runner.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "compressor/resume/journal.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "tests/daemon/support/running_jobs.h"
#include "tests/daemon/support/unkillable.h"
#include "tests/support/run_command.h"

namespace weir::job_runner_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

using JobRunnerTest = RunningJobs;

TEST_F(JobRunnerTest, ConvertsWaitingJobs) {
  const Job one = add("a", "one");
  const Job two = add("b", "two");
  const Job bad = add("a", "bad", 100);
  runner_.wake();
  run_until([&] { return idle() && store_.count({JobState::waiting, "", ""}) == 0; });
  EXPECT_EQ(state(one), JobState::done);
  EXPECT_EQ(state(two), JobState::done);
  EXPECT_EQ(state(bad), JobState::quarantined);
  EXPECT_EQ(runner_.figures().totals().done, 2U);
  EXPECT_EQ(runner_.figures().totals().bytes_in, 2U * 24 * 20 * 16);
  std::map<std::string, std::uint64_t> errors = JobTotals{}.errors;
  EXPECT_EQ(errors.size(), 8U);
  errors["input"] = 1;
  EXPECT_EQ(runner_.figures().totals().errors, errors);
  EXPECT_EQ(runner_.figures().totals().seconds.count(), 2U);
  EXPECT_GT(runner_.figures().bytes_per_s(), 0);
  EXPECT_EQ(list_directory(directory_ / "out").size(), 4U);
  const std::string log = read_file(config_.service.log_file);
  for (const Job& job : {one, two}) {
    EXPECT_NE(log.find(cat(" info start job=", job.id, ' ')), std::string::npos) << log;
    EXPECT_NE(log.find(cat(" info done job=", job.id, ' ')), std::string::npos) << log;
  }
  EXPECT_NE(log.find(cat(" error quarantined job=", bad.id, ' ')), std::string::npos) << log;
}

// While the file system is not mounted, nothing shows whether the source is gone.
TEST_F(JobRunnerTest, JobWaitsWhileTheDirectoryOfItsWatchIsNotThere) {
  const Job job = add("a", "one");
  fs::rename(directory_ / "a", directory_ / "away");
  for (int i = 0; i < 3; ++i) runner_.wake();
  EXPECT_TRUE(idle());
  ASSERT_TRUE(store_.job(job.id)) << "it was forgotten";
  EXPECT_EQ(state(job), JobState::waiting);
  EXPECT_TRUE(changed_.empty());
  fs::rename(directory_ / "away", directory_ / "a");
  runner_.wake();
  run_until([&] { return idle() && state(job) == JobState::done; });
}

// Jobs of an earlier configuration are checked in pieces, and other jobs start in between.
TEST_F(JobRunnerTest, JobThatTheWatchNoLongerTakes_IsForgottenNotConverted) {
  const Job one = add("a", "one");
  const Job two = add("a", "two");
  config_.watches[0].exclude = {"one_*"};
  runner_.configure(config_);
  runner_.wake();
  run_until([&] { return idle() && state(two) == JobState::done; });
  EXPECT_FALSE(store_.job(one.id));
  EXPECT_EQ(list_directory(directory_ / "out").size(), 2U) << "more than the volume and its sidecar";
}

TEST_F(JobRunnerTest, JobIsDoneBeforeItsThumbnailIsRendered) {
  config_.watches[0].thumbnails = true;
  runner_.configure(config_);
  const Job job = add("a", "one");
  runner_.wake();
  run_until([&] { return state(job) == JobState::done; });
  EXPECT_EQ(runner_.running().count(job.id), 1U);
  EXPECT_EQ(store_.job(job.id)->result.outputs.at(0).thumbnail, "");
  EXPECT_EQ(runner_.figures().totals().done, 1U);
  run_until([&] { return idle(); });
  EXPECT_EQ(store_.job(job.id)->result.outputs.at(0).thumbnail, directory_ / "out/one_24x20x16_uint8.nvdb.png");
  EXPECT_EQ(runner_.figures().totals().done, 1U);
  EXPECT_TRUE(store_.unrendered().empty());
}

TEST_F(JobRunnerTest, ThumbnailsThatTheServiceEndedBefore_AreRenderedAtTheNextStart) {
  const Job job = add("a", "one");
  const Job moved = add("a", "moved");
  runner_.wake();
  run_until([&] { return idle() && store_.count({JobState::done, "", ""}) == 2; });
  for (const Job& one : {job, moved}) {  // as if the service had ended before the thumbnails were rendered
    const JobResult result = store_.job(one.id)->result;
    ASSERT_TRUE(store_.retry(one.id, true));
    store_.enqueue(one.id);
    ASSERT_TRUE(store_.start(one.id));
    ASSERT_TRUE(store_.finish(one.id, result, true));
  }
  const std::string output = store_.job(moved.id)->result.outputs.at(0).path;
  fs::remove(output);
  fs::remove(job.source);  // as delete-after-verify does
  config_.watches[0].thumbnails = true;
  runner_.configure(config_);
  runner_.resume_thumbnails();
  runner_.wake();
  EXPECT_EQ(state(job), JobState::done);
  run_until([&] { return idle(); });
  EXPECT_EQ(store_.job(job.id)->result.outputs.at(0).thumbnail, directory_ / "out/one_24x20x16_uint8.nvdb.png");
  EXPECT_EQ(store_.job(moved.id)->result.outputs.at(0).thumbnail, "");
  EXPECT_FALSE(fs::exists(output));
  EXPECT_EQ(runner_.figures().totals().done, 2U);
  EXPECT_TRUE(store_.unrendered().empty());
}

TEST_F(JobRunnerTest, ThumbnailThatIsCancelled_LeavesTheJobDoneAndItsSlotFree) {
  config_.watches[0].thumbnails = true;
  runner_.configure(config_);
  const Job job = add("a", "one");
  runner_.wake();
  run_until([&] { return state(job) == JobState::done; });
  EXPECT_TRUE(runner_.end_rendering(job));
  run_until([&] { return idle(); });
  EXPECT_EQ(state(job), JobState::done);
  EXPECT_TRUE(store_.unrendered().empty());
  EXPECT_FALSE(runner_.end_rendering(job));
}

TEST_F(JobRunnerTest, RunsNoMoreJobsAtOnceThanConfigured) {
  config_.service.jobs = 2;
  config_.service.memory = std::uint64_t{1} << 30U;
  runner_.configure(config_);
  for (const char* name : {"1", "2", "3", "4"}) add("a", name);
  runner_.wake();
  std::size_t most = 0;
  run_until([&] {
    most = std::max(most, runner_.running().size());
    return idle() && store_.count({JobState::done, "", ""}) == 4;
  });
  EXPECT_EQ(most, 2U);
}

TEST_F(JobRunnerTest, SourceChangedWhileWaiting_IsReportedNotConverted) {
  const Job job = add("a", "one");
  write_file(job.source, "rewritten");
  runner_.wake();
  EXPECT_TRUE(idle());
  EXPECT_EQ(changed_.front(), job.source);
}

TEST_F(JobRunnerTest, OutputThatAnotherProcessWrites_IsWaitedForWithoutAnAttempt) {
  const Job job = add("a", "one");
  fs::create_directory(directory_ / "out");
  const std::string partial = directory_ / "out/one_24x20x16_uint8.nvdb.partial";
  auto other = make_posix_file_system()->create(partial);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(i == 0 || store_.retry(job.id));
    runner_.wake();
    run_until([&] { return idle() && state(job) == JobState::waiting; });
    const std::optional<Job> now = store_.job(job.id);
    EXPECT_EQ(now->attempts, 0);
    EXPECT_EQ(now->result.reason,
              partial + ": is being written by another process or conversion; wait for it or choose another output");
  }
  const std::string log = read_file(config_.service.log_file);
  EXPECT_NE(log.find(cat(" warning output-busy job=", job.id, " reason=\"", partial, ": is being written")),
            std::string::npos)
      << log;
  other.reset();
  fs::remove(partial);
  ASSERT_TRUE(store_.retry(job.id));
  runner_.wake();
  run_until([&] { return state(job) == JobState::done; });
}

TEST_F(JobRunnerTest, StartsNothingWhilePaused) {
  const Job job = add("a", "one");
  runner_.pause();
  runner_.wake();
  EXPECT_TRUE(idle());
  EXPECT_EQ(runner_.hold(), "paused by request");
  runner_.resume();
  EXPECT_EQ(runner_.hold(), "");
  run_until([&] { return state(job) == JobState::done; });
}

TEST_F(JobRunnerTest, AbandonEndsACancelledJob) {
  const Job job = add_long();
  runner_.wake();
  run_until([&] { return runner_.running().at(job.id).work->fraction().has_value(); });
  EXPECT_TRUE(store_.cancel(job.id));
  runner_.abandon(job.id);
  run_until([&] { return idle(); });
  EXPECT_EQ(state(job), JobState::cancelled);
  EXPECT_EQ(list_directory(directory_ / "out"), std::vector<std::string>{});
}

// Nobody continues a cancelled job; `retry` starts from the beginning.
TEST_F(JobRunnerTest, CancelRemovesResumableWorkFiles) {
  config_.watches[0].convert_options = {"--save-interval=0"};
  runner_.configure(config_);
  const Job running = add_long();
  const Job waiting = add("b", "waits");
  const Job other = add("b", "other");
  runner_.pause();
  for (const Job& job : {waiting, other}) {
    const auto files = make_posix_file_system();
    const std::string output = directory_ / ("out/" + fs::path(job.source).stem().string() + ".nvdb");
    fs::create_directories(directory_ / "out");
    Journal journal(*files, output, {{"source", job.source}}, {"", 0, nullptr, nullptr, {}});
    journal.open("rows")->preallocate(1);
    journal.state.survey.done.add({{0, 0, 0}, {1, 1, 1}});
    journal.save_now();
  }
  EXPECT_TRUE(store_.cancel(waiting.id));
  runner_.cancelled(waiting);
  const std::vector<std::string> others{".other_24x20x16_uint8.nvdb.work/", ".other_24x20x16_uint8.nvdb.work/journal",
                                        ".other_24x20x16_uint8.nvdb.work/rows"};
  EXPECT_EQ(list_directory(directory_ / "out"), others);

  EXPECT_TRUE(store_.cancel(other.id));
  runner_.resume();
  const fs::path journal = directory_ / "out/.long_1024x1024x1024_uint8.nvdb.work/journal";
  run_until([&] { return fs::exists(journal); });
  EXPECT_TRUE(store_.cancel(running.id));
  runner_.cancelled(running);
  run_until([&] { return idle(); });
  EXPECT_EQ(state(running), JobState::cancelled);
  EXPECT_EQ(list_directory(directory_ / "out"), others);
  EXPECT_NE(read_file(config_.service.log_file).find(cat(" info cleaned job=", running.id, " removed=")),
            std::string::npos);
}

TEST_F(JobRunnerTest, ShutDownLetsAJobFinishWithinTheGracePeriod) {
  const Job job = add("a", "one");
  runner_.wake();
  bool stopped = false;
  runner_.shut_down(milliseconds(20'000), [&] { stopped = true; });
  const Job late = add("a", "late");
  runner_.wake();
  run_until([&] { return stopped; });
  EXPECT_EQ(state(job), JobState::done);
  EXPECT_EQ(state(late), JobState::waiting);
}

TEST_F(JobRunnerTest, ShutDown_JobOutlastsTheGrace_WaitsAgainWithoutAnAttempt) {
  const Job job = add_long();
  runner_.wake();
  run_until([&] { return runner_.running().at(job.id).work->fraction().has_value(); });
  bool stopped = false;
  runner_.shut_down(milliseconds(1), [&] { stopped = true; });
  run_until([&] { return stopped; });
  EXPECT_EQ(state(job), JobState::waiting);
  EXPECT_EQ(store_.job(job.id)->attempts, 0);
  EXPECT_EQ(store_.job(job.id)->due_ms, 0);
  for (const std::string& left : list_directory(directory_ / "out")) {
    EXPECT_NE(left.find(".nvdb.work/"), std::string::npos) << left << " is neither nothing nor where it continues";
  }
}

// A killed process may not end, for example while it waits for a hanging disk.
TEST_F(JobRunnerTest, Kill_ProcessThatDoesNotEnd_IsLeftBehind) {
  if (!Unkillable::possible()) GTEST_SKIP() << "only root may have processes that it cannot kill";
  JobRunner runner(io_, store_, log_, write_program("exec sleep 600\n"), [](const Job&) {});
  runner.configure(config_);
  const Job job = add("a", "one");
  runner.wake();
  ASSERT_EQ(state(job), JobState::running);
  int stopped = 0;
  const auto begin = std::chrono::steady_clock::now();
  {
    const Unkillable unkillable;
    runner.shut_down(milliseconds(600'000), [&] { ++stopped; });
    runner.kill();
    runner.kill();
    run_until([&] { return stopped > 0; });
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(5000));
  for (int i = 0; i < 5; ++i) io_.run_one_for(milliseconds(10));
  EXPECT_EQ(stopped, 1);
  EXPECT_EQ(runner.running().count(job.id), 1U);
  EXPECT_EQ(state(job), JobState::running) << "it waits at the next start";
  EXPECT_EQ(store_.job(job.id)->attempts, 0);
  const std::string log = read_file(config_.service.log_file);
  EXPECT_NE(log.find(cat(" warning left-running job=", job.id, " source=", job.source, " step=convert")),
            std::string::npos)
      << log;
}

TEST_F(JobRunnerTest, ShutDown_ProcessThatDoesNotEnd_IsLeftBehindAfterTheGrace) {
  if (!Unkillable::possible()) GTEST_SKIP() << "only root may have processes that it cannot kill";
  JobRunner runner(io_, store_, log_, write_program("exec sleep 600\n"), [](const Job&) {});
  runner.configure(config_);
  const Job job = add("a", "one");
  runner.wake();
  ASSERT_EQ(state(job), JobState::running);
  bool stopped = false;
  const auto begin = std::chrono::steady_clock::now();
  {
    const Unkillable unkillable;
    runner.shut_down(milliseconds(1), [&] { stopped = true; });
    run_until([&] { return stopped; });
  }
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(5000)) << "it had the time to end by itself";
  EXPECT_EQ(runner.running().count(job.id), 1U);
  EXPECT_EQ(state(job), JobState::running);
}

// The usual case: killed jobs are recorded in the state file.
TEST_F(JobRunnerTest, Kill_EndsTheStopWithTheLastProcess) {
  const Job job = add_long();
  runner_.wake();
  run_until([&] { return runner_.running().at(job.id).work->fraction().has_value(); });
  int stopped = 0;
  runner_.shut_down(milliseconds(600'000), [&] { ++stopped; });
  runner_.kill();
  run_until([&] { return stopped > 0; });
  EXPECT_TRUE(idle());
  EXPECT_EQ(state(job), JobState::waiting);
  EXPECT_EQ(store_.job(job.id)->attempts, 0);
  for (int i = 0; i < 30; ++i) io_.run_one_for(milliseconds(50));
  EXPECT_EQ(stopped, 1);
  EXPECT_EQ(read_file(config_.service.log_file).find(" left-running "), std::string::npos);
}

}  // namespace
}  // namespace weir::job_runner_test
