#include "daemon/store/job_store.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/daemon/support/stored_jobs.h"
#include "tests/support/run_command.h"
#include "tests/support/scoped_mount.h"

namespace weir::job_store_fault_test {
namespace {

using Change = JobStore::Change;
using test::failure;
using test::kIdentity;
using test::StoredJobs;
using test::success;

TEST_F(StoredJobs, TogetherCommitsAllOrNothing) {
  EXPECT_THROW(store_->together([&] {
    waiting("/in/a.raw");
    waiting("/in/b.raw");
    throw Error(ErrorKind::internal, "in between");
  }),
               Error);
  EXPECT_EQ(store_->count({}), 0U);
  store_->together([&] {
    for (int i = 0; i < 2000; ++i) waiting(cat("/in/", i, ".raw"));
  });
  EXPECT_EQ(store_->count({JobState::waiting, "", ""}), 2000U);
}

// The second reading of the clock fails, the one for the next attempt.
TEST_F(StoredJobs, PostponementThatFailsHalfway_ChangesNothing) {
  store_.reset();
  int times = 10;
  JobStore store(directory_ / "weir.db", [&] {
    if (times-- == 0) throw Error(ErrorKind::io, "no time");
    return now_;
  });
  const std::int64_t id = store.observe("w", "/in/a.raw", kIdentity, "").job.id;
  store.enqueue(id);
  store.start(id);
  times = 1;
  EXPECT_THROW(store.postpone(id, "busy", 30'000), Error);
  times = 10;
  EXPECT_EQ(store.job(id)->state, JobState::running);
  EXPECT_TRUE(store.postpone(id, "busy", 30'000));
  EXPECT_EQ(store.next_due_ms(), 30'000);
}

TEST_F(StoredJobs, FullDisk_RefusesWritesAndKeepsStoredJobs) {
  const std::string place = directory_ / "small";
  std::filesystem::create_directory(place);
  const ScopedMount mount(place, 1 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  const std::string state = place + "/weir.db";
  auto store = std::make_unique<JobStore>(state);
  const std::int64_t known = store->observe("w", "/in/known.raw", kIdentity, "").job.id;
  store->enqueue(known);
  std::string filler(1 << 20, 'x');
  try {
    write_file(place + "/filler", filler);
  } catch (const std::system_error&) {
    // Now the disk is full.
  }
  std::string message;
  int added = 0;
  for (; message.empty() && added < 1000; added += message.empty() ? 1 : 0) {
    try {
      store->observe("w", cat("/in/", added, ".raw"), kIdentity, std::string(1000, 'o'));
    } catch (const Error& error) {
      message = error.what();
      EXPECT_EQ(error.kind(), ErrorKind::io);
    }
  }
  EXPECT_EQ(message, state + ": cannot use the state: database or disk is full; make room");
  EXPECT_THROW(store->start(known), Error);
  EXPECT_EQ(store->job(known)->state, JobState::waiting);
  EXPECT_EQ(store->count({}), static_cast<std::uint64_t>(added + 1));
  std::filesystem::remove(place + "/filler");
  EXPECT_TRUE(store->start(known));
  EXPECT_TRUE(store->finish(known, success()));
  store.reset();
  store = std::make_unique<JobStore>(state);
  EXPECT_EQ(store->notice(), "");
  EXPECT_EQ(store->job(known)->result, success());
}

// A process makes one step after the other and announces each completed step; it is killed at a random moment.
TEST_F(StoredJobs, KillAtAnyMoment_LosesNoCompletedStep) {
  store_.reset();
  std::mt19937 random(5);
  std::vector<JobState> reached;  // announced states of the jobs 1, 2, ...
  for (int round = 0; round < 30; ++round) {
    int said[2];
    ASSERT_EQ(pipe(said), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      JobStore store(directory_ / "weir.db");
      const auto say = [&](char step) { return write(said[1], &step, 1) == 1; };
      for (int i = 0;; ++i) {
        const std::int64_t id = store.observe("w", cat("/in/", round, '_', i, ".raw"), kIdentity, "").job.id;
        if (!say('o') || !store.enqueue(id) || !say('e') || !store.start(id) || !say('s')) _exit(1);
        if (!store.finish(id, success()) || !say('f')) _exit(1);
      }
    }
    close(said[1]);
    const auto hear = [&] {
      char step = 0;
      if (read(said[0], &step, 1) != 1) return false;
      if (step == 'o') reached.push_back(JobState::discovered);
      if (step == 'e') reached.back() = JobState::waiting;
      if (step == 's') reached.back() = JobState::running;
      if (step == 'f') reached.back() = JobState::done;
      return true;
    };
    for (int steps = std::uniform_int_distribution<int>(1, 40)(random); steps > 0; --steps) ASSERT_TRUE(hear());
    std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution<int>(0, 3'000)(random)));
    kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the process ended by itself";
    while (hear()) {
    }
    close(said[0]);
    const JobStore store(directory_ / "weir.db");
    ASSERT_EQ(store.notice(), "");
    // One step may have been made and not announced.
    const std::uint64_t jobs = store.count({});
    ASSERT_TRUE(jobs == reached.size() || jobs == reached.size() + 1) << jobs << " of " << reached.size();
    for (std::size_t i = 0; i < jobs; ++i) {
      const Job job = store.job(static_cast<std::int64_t>(i + 1)).value();
      if (i == reached.size()) reached.push_back(JobState::discovered);
      const JobState next = reached[i] == JobState::discovered ? JobState::waiting
                            : reached[i] == JobState::running  ? JobState::done
                                                               : reached[i];
      const JobState now = reached[i] == JobState::running ? JobState::waiting : reached[i];
      EXPECT_TRUE(job.state == now || job.state == next) << job.source << ' ' << job_state_name(job.state);
      EXPECT_EQ(job.result, job.state == JobState::done ? success() : JobResult());
      EXPECT_EQ(job.attempts, 0);
      reached[i] = job.state;
    }
  }
}

}  // namespace
}  // namespace weir::job_store_fault_test
