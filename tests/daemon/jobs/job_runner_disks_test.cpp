// Tests JobRunner with full file systems.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "format/base/text.h"
#include "tests/daemon/support/running_jobs.h"
#include "tests/support/run_command.h"
#include "tests/support/scoped_mount.h"

namespace weir::job_runner_disks_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

// /proc plays the full disk: it exists everywhere and is a file system of its own.
class JobRunnerDisksTest : public RunningJobs {
 protected:
  /// Writes a `weir` that finds no room at `path` and counts its starts.
  std::string full_at(const std::string& path) const {
    return write_program(cat("echo >>", starts_, "\necho '{\"failed\": \"no room\", \"errno\": 28, \"path\": \"", path,
                             "\"}' >&$fd\nexit 5\n"));
  }
  std::size_t starts() const {
    const std::string lines = read_file(starts_);
    return static_cast<std::size_t>(std::ranges::count(lines, '\n'));
  }
  void run_for(milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) io_.run_one_for(milliseconds(20));
  }

  std::string starts_ = directory_ / "starts";
};

// A file server behind FUSE may report no size.
TEST_F(JobRunnerDisksTest, FullDiskOfUnknownSize_IsWaitedForWithoutAnAttempt) {
  const std::string program = write_program(
      "echo '{\"planned\": 1000}' >&$fd\n"
      "echo '{\"failed\": \"no room\", \"errno\": 28, \"path\": \"/proc/a.nvdb\"}' >&$fd\nexit 5\n");
  config_.watches[0].output = "/proc";
  JobRunner runner(io_, store_, log_, program, [](const Job&) {});
  runner.configure(config_);
  const Job job = add("a", "one");
  runner.wake();
  EXPECT_EQ(state(job), JobState::running);
  run_until([&] { return state(job) == JobState::waiting; });
  EXPECT_EQ(store_.job(job.id)->attempts, 0);
  EXPECT_EQ(store_.job(job.id)->result.reason, "no room");
}

// For example, an output in memory spills to /var/tmp: no disk that is asked for its room shows when there is some.
TEST_F(JobRunnerDisksTest, FullDiskOfNeitherOutputNorWorkDir_IsTriedAgainAfterAWhile) {
  JobRunner runner(io_, store_, log_, full_at("/proc"), [](const Job&) {});
  runner.configure(config_);
  const Job job = add("a", "one");
  runner.wake();
  run_until([&] { return state(job) == JobState::waiting; });
  const std::int64_t delay_ms = store_.job(job.id)->due_ms - JobStore::wall_clock_ms();
  EXPECT_GT(delay_ms, 20'000);
  EXPECT_LE(delay_ms, 30'000);
  EXPECT_EQ(store_.job(job.id)->attempts, 0);
  run_for(milliseconds(1500));
  EXPECT_EQ(starts(), 1U) << "started again and again";
  EXPECT_EQ(runner.hold(), "") << "others may find room where they spill";
  EXPECT_EQ(runner.waits_for_disks(), "no room in /proc");
}

TEST_F(JobRunnerDisksTest, FullWorkDir_IsWaitedForByAll) {
  config_.service.work_dir = "/proc";
  JobRunner runner(io_, store_, log_, full_at("/proc"), [](const Job&) {});
  runner.configure(config_);
  const Job job = add("a", "one");
  runner.wake();
  run_until([&] { return state(job) == JobState::waiting; });
  EXPECT_EQ(store_.job(job.id)->due_ms, 0) << "it goes on as soon as there is room";
  run_until([&] { return !runner.hold().empty(); });
  EXPECT_EQ(runner.hold(), "no room in /proc");
  add("b", "two");
  run_for(milliseconds(1500));
  EXPECT_EQ(starts(), 1U);
}

TEST_F(JobRunnerDisksTest, FullDiskOfOneOutput_HoldsOnlyItsJobs) {
  const std::string program =
      write_program(cat("case \"$*\" in *--output=/proc*) echo '{\"failed\": \"no room\", \"errno\": 28, \"path\": "
                        "\"/proc/a.nvdb\"}' >&$fd; exit 5;; esac\nexec ",
                        WEIR_COMMAND, " \"$@\"\n"));
  config_.watches[0].output = "/proc";
  JobRunner runner(io_, store_, log_, program, [](const Job&) {});
  runner.configure(config_);
  const Job waits = add("a", "one");
  runner.wake();
  run_until([&] { return state(waits) == JobState::waiting && runner.disks().size() == 2; });
  const Job goes_on = add("b", "two");
  EXPECT_EQ(runner.hold(), "") << "nothing is paused";
  EXPECT_TRUE(runner.waits_for_disks().starts_with("no room in /proc, where ")) << runner.waits_for_disks();
  run_until([&] { return state(goes_on) == JobState::done; });
  EXPECT_EQ(state(waits), JobState::waiting);
  runner.pause();
  EXPECT_EQ(runner.hold(), "paused by request");
  runner.resume();

  config_.watches[1].output = "/proc";
  runner.configure(config_);
  run_until([&] { return runner.disks().size() == 1; });
  EXPECT_TRUE(runner.hold().starts_with("no room in /proc, where ")) << runner.hold();
}

// A full disk must not lose a picture: the job is done, and nothing else would request the picture again.
TEST_F(JobRunnerDisksTest, ThumbnailThatFindsNoRoom_IsRenderedWhenThereIsSome) {
  const std::string out = directory_ / "out";
  const std::string ballast = out + "/ballast";
  fs::create_directory(out);
  const ScopedMount mount(out, 8 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  write_file(ballast, std::string(3 << 20, 'x'));
  const std::string program = write_program(
      cat("if [ $1 = render ] && [ -e ", ballast, " ]; then echo >>", starts_,
          "; echo 'weir: a.png.partial: cannot write 9 bytes at offset 0: No space left on device' >&2; exit 5; fi\n",
          "exec ", WEIR_COMMAND, " \"$@\"\n"));
  config_.watches[0].thumbnails = true;
  JobRunner runner(io_, store_, log_, program, [](const Job&) {});
  runner.configure(config_);
  const Job job = add("a", "one");
  runner.wake();
  run_until([&] { return state(job) == JobState::done && runner.running().empty(); });
  EXPECT_EQ(store_.unrendered(), std::vector<std::int64_t>{job.id}) << "a restart takes it up, too";
  EXPECT_EQ(store_.job(job.id)->result.outputs.at(0).thumbnail, "");
  const std::string log = read_file(config_.service.log_file);
  EXPECT_NE(
      log.find(cat(" error disk-full job=", job.id, " directory=", out, " reason=\"no thumbnail: a.png.partial: ")),
      std::string::npos)
      << log;
  run_for(milliseconds(1500));
  EXPECT_EQ(starts(), 1U) << "tried again without room";
  fs::remove(ballast);
  run_until([&] { return store_.unrendered().empty(); });
  EXPECT_EQ(store_.job(job.id)->result.outputs.at(0).thumbnail, out + "/one_24x20x16_uint8.nvdb.png");
  EXPECT_TRUE(fs::exists(out + "/one_24x20x16_uint8.nvdb.png"));
  EXPECT_EQ(runner.figures().totals().done, 1U);
}

// A link stands for the mount point: first it leads to a plain directory, then to a mounted file system.
TEST_F(JobRunnerDisksTest, OutputMountWithoutAFileSystem_HoldsOnlyItsJobs) {
  const std::string mount = directory_ / "mount";
  fs::create_directory_symlink(directory_.path(), mount);
  config_.watches[0].output_mount = mount;
  runner_.configure(config_);
  const Job waits = add("a", "one");
  const Job goes_on = add("b", "two");
  runner_.wake();
  run_until([&] { return state(goes_on) == JobState::done; });
  run_for(milliseconds(1500));
  EXPECT_EQ(state(waits), JobState::waiting);
  EXPECT_EQ(store_.job(waits.id)->attempts, 0);
  EXPECT_EQ(runner_.hold(), "") << "nothing is paused";
  EXPECT_EQ(runner_.waits_for_disks(), cat("no file system is mounted at ", mount));

  fs::remove(mount);
  fs::create_directory_symlink("/proc", mount);
  run_until([&] { return state(waits) == JobState::done; });
  EXPECT_EQ(runner_.waits_for_disks(), "");
  const std::string log = read_file(config_.service.log_file);
  const std::string said = cat(" error output-not-mounted mount=", mount, " reason=");
  ASSERT_NE(log.find(said), std::string::npos) << log;
  EXPECT_EQ(log.find(said), log.rfind(said)) << "said more than once";
  EXPECT_NE(log.find(cat(" info output-mounted mount=", mount, "\n")), std::string::npos) << log;
}

TEST_F(JobRunnerDisksTest, ConfigurationWithoutTheOutputMount_StartsTheJobsThatWaitedForIt) {
  config_.watches[0].output_mount = directory_.path();
  runner_.configure(config_);
  const Job job = add("a", "one");
  runner_.wake();
  EXPECT_EQ(runner_.waits_for_disks(), cat("no file system is mounted at ", directory_.path().string()));
  config_.watches[0].output_mount.clear();
  runner_.configure(config_);
  EXPECT_EQ(runner_.waits_for_disks(), "");
  runner_.wake();
  run_until([&] { return state(job) == JobState::done; });
}

// The thumbnail of a job that was done before is not given up because its output is out of sight.
TEST_F(JobRunnerDisksTest, OutputMountWithoutAFileSystem_ThumbnailsWait) {
  config_.watches[0].thumbnails = true;
  const std::string program =
      write_program(cat("case \"$1\" in render) exec sleep 100;; esac\nexec ", WEIR_COMMAND, " \"$@\"\n"));
  const Job job = add("a", "one");
  {
    JobRunner runner(io_, store_, log_, program, [](const Job&) {});
    runner.configure(config_);
    runner.wake();
    run_until([&] { return state(job) == JobState::done; });
  }
  ASSERT_EQ(store_.unrendered(), std::vector<std::int64_t>{job.id});

  const std::string mount = directory_ / "mount";
  fs::create_directory_symlink(directory_.path(), mount);
  config_.watches[0].output_mount = mount;
  fs::rename(directory_ / "out", directory_ / "away");
  runner_.configure(config_);
  runner_.resume_thumbnails();
  runner_.wake();
  run_for(milliseconds(1500));
  EXPECT_EQ(store_.unrendered(), std::vector<std::int64_t>{job.id});
  fs::rename(directory_ / "away", directory_ / "out");
  fs::remove(mount);
  fs::create_directory_symlink("/proc", mount);
  run_until([&] { return store_.unrendered().empty() && idle(); });
  EXPECT_TRUE(fs::exists(directory_ / "out/one_24x20x16_uint8.nvdb.png"));
}

TEST_F(JobRunnerDisksTest, FileSystemOfAnOutput_CannotBeUnmountedWhileItsJobRuns) {
  const std::string out = directory_ / "out";
  fs::create_directory(out);
  ScopedMount mount(out, 8 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  config_.watches[0].output_mount = out;
  JobRunner runner(io_, store_, log_, write_program("exec sleep 100\n"), [](const Job&) {});
  runner.configure(config_);
  const Job job = add("a", "one");
  runner.wake();
  EXPECT_EQ(state(job), JobState::running);
  EXPECT_NE(::umount(out.c_str()), 0);
  EXPECT_EQ(errno, EBUSY);
}

// The running job can no longer write its output, as after `umount -l`. This is no fault of the job.
TEST_F(JobRunnerDisksTest, OutputMountThatGoesWhileAJobRuns_CostsNoAttempt) {
  const std::string mount = directory_ / "mount";
  fs::create_directory_symlink("/proc", mount);
  config_.watches[0].output_mount = mount;
  const std::string program =
      write_program(cat("ln -sfn ", directory_.path().string(), " ", mount,
                        "\necho '{\"failed\": \"cannot write\", \"errno\": 5}' >&$fd\nexit 5\n"));
  JobRunner runner(io_, store_, log_, program, [](const Job&) {});
  runner.configure(config_);
  const Job job = add("a", "one");
  runner.wake();
  EXPECT_EQ(state(job), JobState::running);
  run_until([&] { return state(job) == JobState::waiting; });
  EXPECT_EQ(store_.job(job.id)->attempts, 0);
  EXPECT_EQ(store_.job(job.id)->result.reason, "cannot write");
  EXPECT_EQ(runner.waits_for_disks(), cat("no file system is mounted at ", mount));
  const std::string log = read_file(config_.service.log_file);
  EXPECT_NE(log.find(cat(" warning output-lost job=", job.id, " mount=", mount, " reason=\"cannot write\"\n")),
            std::string::npos)
      << log;
}

}  // namespace
}  // namespace weir::job_runner_disks_test
