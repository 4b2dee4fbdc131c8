// Tests faults around the service, and its messages and actions.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "format/base/text.h"
#include "tests/daemon/support/service_harness.h"
#include "tests/support/scoped_mount.h"

namespace weir::watch_faults_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using Names = std::vector<std::string>;

TEST(WatchFaults, ALostStateFileIsRebuiltFromTheOutputs) {
  ServiceHarness service;
  const std::string one = service.add("one", 3);
  const std::string two = service.add("two", 5);
  service.start();
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  EXPECT_EQ(service.stop(), 0);
  const auto made = fs::last_write_time(service.out(one + ".nvdb"));

  for (const char* suffix : {"-wal", "-shm"}) fs::remove(service.path(std::string("weir.db") + suffix));
  write_file(service.path("weir.db"), std::string("SQLite format 3\0", 16) + "and nothing else of a database");
  service.start();
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  EXPECT_TRUE(fs::exists(service.path("weir.db.corrupt-1"))) << "kept aside";
  EXPECT_EQ(service.logged("state-file "), 1U) << service.log();
  EXPECT_EQ(service.logged("done already"), 2U) << service.log();
  EXPECT_EQ(fs::last_write_time(service.out(one + ".nvdb")), made);
  EXPECT_EQ(service.get("/api/status")["done_total"], 0) << "no conversion in this process";
}

TEST(WatchFaults, FullDiskOfTheStateFile_PausesAllJobsUntilThereIsRoom) {
  ServiceHarness service("state = \"state/weir.db\"\n");
  fs::create_directory(service.path("state"));
  ScopedMount mount(service.path("state"), 8 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  service.start();
  {
    std::ofstream ballast(service.path("state/ballast"));
    while (ballast << std::string(4096, 'x') << std::flush) {
    }
  }
  for (int i = 0; i < 20; ++i) service.add(cat("v", i));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" state-file-fault ") > 0; })) << service.log();
  std::this_thread::sleep_for(milliseconds(2500));  // the service tries again each second
  EXPECT_LE(service.logged(" state-file-fault "), 2U) << "said once by each who needs it\n" << service.log();
  const auto watch = service.get("/api/status")["watches"][0];
  EXPECT_EQ(watch["up"], false) << "what is found cannot be written down: /readyz says so";
  EXPECT_NE(watch["reason"].get<std::string>().find("weir.db"), std::string::npos) << watch;
  fs::remove(service.path("state/ballast"));
  ASSERT_TRUE(service.eventually_done(20)) << service.log();
  EXPECT_EQ(service.logged(" discovered "), 20U) << service.log();
  EXPECT_EQ(service.logged(" start "), 20U);
  EXPECT_EQ(service.stop(), 0);
}

TEST(WatchFaults, FullDiskOfTheStateFile_WhileJobsWait_IsNotSaidEachSecond) {
  ServiceHarness service("state = \"state/weir.db\"\n");
  fs::create_directory(service.path("state"));
  ScopedMount mount(service.path("state"), 8 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  service.start();
  service.post("/api/pause");
  for (int i = 0; i < 20; ++i) service.add(cat("v", i));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("waiting") == 20; })) << service.log();
  {
    std::ofstream ballast(service.path("state/ballast"));
    while (ballast << std::string(4096, 'x') << std::flush) {
    }
  }
  service.post("/api/resume");
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" state-file-fault ") > 0; })) << service.log();
  std::this_thread::sleep_for(milliseconds(3500));  // the service tries again each second
  EXPECT_LE(service.logged(" state-file-fault "), 2U) << service.log();
  fs::remove(service.path("state/ballast"));
  ASSERT_TRUE(service.eventually_done(20)) << service.log();
  EXPECT_EQ(service.stop(), 0);
}

TEST(WatchFaults, SecondSourceOfTheSameOutput_FailsWithTheReason) {
  ServiceHarness service;
  const std::string name = service.add("same", 3);
  service.start();
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  write_file(service.in(name + ".nrrd"),
             "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 20 16\nencoding: raw\n\n" + ServiceHarness::volume(5));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("failed") == 1; })) << service.log();
  EXPECT_EQ(service.job(name + ".nrrd")["reason"],
            cat(service.out(name), ".nvdb: exists and is not of ", service.in(name), ".nrrd (was made of ",
                service.in(name), ".raw); move that file away, or choose another output or name"));
  EXPECT_EQ(service.job(name + ".nrrd")["attempts"], 1);
  EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
}

TEST(WatchFaults, AFullDiskPausesUntilThereIsRoom) {
  ServiceHarness service;
  ScopedMount mount(service.out(), 2 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  write_file(service.out("ballast"), std::string(1800 << 10, 'x'));
  service.start();
  const std::string name = service.add("one", 3);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" disk-full ") == 1; })) << service.log();
  const auto status = service.get("/api/status");
  EXPECT_EQ(status["state"], "paused");
  EXPECT_TRUE(status["reason"].get<std::string>().starts_with("no room in " +
                                                              service.out().substr(0, service.out().size() - 1)))
      << status["reason"];
  EXPECT_EQ(service.count("waiting"), 1U);
  EXPECT_EQ(service.job(name + ".raw")["attempts"], 0);
  EXPECT_EQ(list_directory(service.out()), Names{"ballast"});
  fs::remove(service.out("ballast"));
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
  EXPECT_EQ(service.logged(" disk-has-room "), 1U);
  EXPECT_EQ(service.stop(), 0);
}

TEST(WatchFaults, OutputNotMounted_JobsWaitAndNothingIsWrittenBelowTheMountPoint) {
  ServiceHarness service("", "output_mount = \"out\"\nsettle = 0.2\n");
  service.start();
  const std::string name = service.add("one", 3);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("waiting") == 1; })) << service.log();
  EXPECT_EQ(service.logged(" output-not-mounted "), 1U);
  const auto status = service.get("/api/status");
  EXPECT_EQ(status["state"], "running");
  EXPECT_EQ(status["reason"], "no file system is mounted at " + service.out().substr(0, service.out().size() - 1));
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));  // the service looks each second
  EXPECT_EQ(list_directory(service.out()), Names{});
  ScopedMount mount(service.out(), 8 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
  EXPECT_EQ(service.logged(" output-mounted "), 1U);
  EXPECT_EQ(service.get("/api/status")["reason"], "");
  ASSERT_TRUE(ServiceHarness::eventually([&] { return ::umount(service.out().c_str()) == 0; }));
  EXPECT_EQ(service.get("/api/status")["reason"], status["reason"]) << "an idle service looks when it is asked";
  EXPECT_EQ(service.stop(), 0);
}

// One output is larger than the free space of its disk, another one larger than a whole disk. Neither delays outputs
// that fit.
TEST(WatchFaults, OutputThatDoesNotFit_DelaysOnlyJobsAsLargeOnThatDisk) {
  ServiceHarness service("", "size = \"400000\"\nsettle = 0.2\n");
  ScopedMount mount(service.out(), 2 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  fs::create_directory(service.path("far"));
  fs::create_directory(service.path("far_out"));
  std::string text = read_file(service.path("weir.toml"));
  text += "[[watch]]\ndirectory = \"far\"\noutput = \"far_out\"\n";
  text += "[[watch]]\ndirectory = \"large\"\noutput = \"out/large\"\nsize = \"5000000\"\n";
  write_file(service.path("weir.toml"), text);
  fs::create_directory(service.path("large"));
  write_file(service.out("ballast"), std::string(1700 << 10, 'x'));
  service.start();
  const std::string waits = service.add("waits", 3);
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" disk-full ") == 1; })) << service.log();
  const std::string never = service.path(std::string("large/never") + ServiceHarness::kSuffix + ".raw");
  write_file(never, ServiceHarness::volume(4));
  write_file(service.path(std::string("far/goes") + ServiceHarness::kSuffix + ".raw"), ServiceHarness::volume(5));
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_TRUE(fs::exists(service.path(std::string("far_out/goes") + ServiceHarness::kSuffix + ".nvdb")));
  EXPECT_EQ(service.job(waits + ".raw")["attempts"], 0) << "there may be room another time";
  const auto status = service.get("/api/status");
  EXPECT_EQ(status["state"], "running") << "the other disk has room";
  EXPECT_NE(status["reason"].get<std::string>().find("; what needs more waits for it"), std::string::npos);
  fs::remove(service.out("ballast"));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" attempt-failed ") > 0; })) << service.log();
  EXPECT_NE(service.log().find("4.8 MiB are needed, and its whole file system has 2.0 MiB; choose another output or a "
                               "smaller size"),
            std::string::npos)
      << service.log();
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  EXPECT_EQ(service.stop(), 0);
}

TEST(WatchFaults, AReadOnlyOutputIsAFailureThatIsTriedAgain) {
  ServiceHarness service;
  ScopedMount mount(service.out(), 8 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  service.start();
  mount.make_read_only();
  const std::string name = service.add("one");
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" attempt-failed ") == 1; })) << service.log();
  const auto job = service.job(name + ".raw");
  EXPECT_EQ(job["state"], "waiting") << "with a delay: the file system may be writable again";
  EXPECT_EQ(job["attempts"], 1);
  EXPECT_EQ(job["exit_code"], 5);
  EXPECT_NE(job["reason"].get<std::string>().find("Read-only file system"), std::string::npos) << job;
  EXPECT_TRUE(job["next_attempt_at"].is_number());
  EXPECT_EQ(service.stop(), 0);
}

TEST(WatchFaults, OutputDirectoryBelowAFile_FailsWithTheReason) {
  ServiceHarness service("", "output = \"file/out\"\n");
  service.start();
  write_file(service.path("file"), "");
  const std::string name = service.add("one");
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" attempt-failed ") == 1; })) << service.log();
  EXPECT_EQ(service.job(name + ".raw")["reason"], service.path("file/out") + ": make the directory: Not a directory");
}

TEST(WatchFaults, AFileThatMayNotBeReadIsTriedAgain) {
  ServiceHarness service;
  service.run_unprivileged();
  const std::string name = service.add("locked");
  fs::permissions(service.in(name + ".raw"), fs::perms::none);
  service.start();
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" attempt-failed ") == 1; })) << service.log();
  const auto job = service.job(name + ".raw");
  EXPECT_EQ(job["state"], "waiting");
  EXPECT_EQ(job["exit_code"], 5);
  EXPECT_NE(job["reason"].get<std::string>().find("Permission denied; give this user the right to read it"),
            std::string::npos)
      << job;
  // Wait for the attempt with a delay of 10 s, which is longer than a busy machine takes to notice the change.
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" attempt-failed ") == 2; })) << service.log();
  const auto due = service.job(name + ".raw")["next_attempt_at"];
  ASSERT_TRUE(due.is_number());
  fs::permissions(service.in(name + ".raw"), fs::perms::all);  // the content of the file is unchanged
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_LT(service.job(name + ".raw")["changed_at"], due) << "it was not noticed at once";
}

// A file that cannot be looked at does not count as deleted. For example, its file server may not answer.
TEST(WatchFaults, FileInAnUnreadableDirectory_KeepsItsJob) {
  ServiceHarness service("", "recursive = true\n");
  service.run_unprivileged();
  fs::create_directory(service.in("sub"));
  write_file(service.in("sub/short_9x9x9_uint8.raw"), "x");
  service.start();
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("quarantined") == 1; })) << service.log();
  EXPECT_EQ(service.stop(), 0);
  fs::permissions(service.in("sub"), fs::perms::none);
  service.add("other");
  service.start();
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.count("quarantined"), 1U) << service.log();
  EXPECT_EQ(service.stop(), 0);
  fs::permissions(service.in("sub"), fs::perms::all);
  fs::remove(service.in("sub/short_9x9x9_uint8.raw"));
  service.start();
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("quarantined") == 0; })) << service.log();
}

TEST(WatchFaults, FileInAnUnreadableDirectory_IsReportedOnceAndTriedAgain) {
  ServiceHarness service("", "recursive = true\nsettle = 3\n");
  service.run_unprivileged();
  fs::create_directory(service.in("sub"));
  const std::string late = service.add("sub/late");
  const std::string other = service.add("other");
  service.start();
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.get("/api/jobs")["total"] == 2; })) << service.log();
  fs::permissions(service.in("sub"), fs::perms::none);
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.logged(
                cat("notice=\"", service.in(late),
                    ".raw: cannot look at it: Permission denied; check the permissions or choose another place\"")),
            1U)
      << service.log();
  // The file may be under a new look at this moment.
  EXPECT_TRUE(ServiceHarness::eventually([&] { return service.count("discovered") == 1; })) << service.log();
  fs::permissions(service.in("sub"), fs::perms::all);
  ASSERT_TRUE(service.eventually_done(2)) << service.log();
  EXPECT_EQ(service.logged(": cannot look at it:"), 1U);
}

TEST(WatchFaults, SourceDeletedWhileWaiting_RemovesItsJob) {
  ServiceHarness service;
  const std::string name = "long_1024x1024x1024_uint8.raw";
  write_file(service.path("tmp"), "");
  fs::resize_file(service.path("tmp"), std::uintmax_t{1} << 30U);
  service.start();
  service.post("/api/pause");
  fs::rename(service.path("tmp"), service.in(name));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("waiting") == 1; })) << service.log();
  fs::remove(service.in(name));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.get("/api/jobs")["total"] == 0; })) << service.log();
  service.post("/api/resume");
  const std::string fine = service.add("fine");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  EXPECT_EQ(service.logged(" attempt-failed "), 0U) << service.log();
}

TEST(WatchFaults, ForeignOutput_IsNotReplaced) {
  ServiceHarness service;
  const std::string name = std::string("one") + ServiceHarness::kSuffix;
  write_file(service.out(name + ".nvdb"), "precious");
  service.start();
  service.add("one");
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("failed") == 1; })) << service.log();
  EXPECT_EQ(read_file(service.out(name + ".nvdb")), "precious");
  EXPECT_EQ(service.job(name + ".raw")["reason"],
            cat(service.out(name), ".nvdb: exists and is not of ", service.in(name),
                ".raw (has no sidecar, so that weir cannot say what it is); move that file away, or choose another "
                "output or name"));
  fs::remove(service.out(name + ".nvdb"));
  EXPECT_EQ(service.post("/api/retry-failed")["retried"], 1);
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
}

// Without a failed job, nobody would learn what is missing.
TEST(WatchFaults, RawFileWithoutATypeInAWatchWithDims_FailsWithWhatIsMissing) {
  ServiceHarness service("", "dims = [24, 20, 16]\n");
  service.start();
  write_file(service.in("plain.raw"), ServiceHarness::volume(3));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.count("failed") == 1; })) << service.log();
  const std::string reason = service.job("plain.raw")["reason"];
  EXPECT_TRUE(reason.starts_with(service.in("plain.raw") + ": type unknown; give type with one of ")) << reason;
}

TEST(WatchFaults, StartedWithSigchldIgnored_DamagedOutputFailsItsVerification) {
  ServiceHarness service;
  service.ignore_sigchld();
  service.start();
  const std::string name = service.add("one", 3);
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  std::string bytes = read_file(service.out(name + ".nvdb"));
  bytes[bytes.size() - 1000] ^= 1;
  write_file(service.out(name + ".nvdb"), bytes);
  service.post(cat("/api/jobs/", service.job(name + ".raw")["id"].get<int>(), "/retry"));
  ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" attempt-failed ") == 1; })) << service.log();
  EXPECT_NE(service.log().find("reason=\"verify: "), std::string::npos) << service.log();
  EXPECT_EQ(service.stop(), 0);
}

TEST(WatchFaults, LeftoversOfAKilledConversionAreCleanedAtStart) {
  ServiceHarness service;
  fs::create_directory(service.out(".old.nvdb.work"));
  write_file(service.out("old.nvdb.partial"), "half");
  write_file(service.out("old.nvdb.json.partial"), "half");
  service.start();
  EXPECT_EQ(list_directory(service.out()), Names{});
  EXPECT_EQ(service.logged(" cleaned "), 3U) << service.log();
}

// A modification time in the future, and one that goes back, both count only as different.
TEST(WatchFaults, SourceTimeJumpsByYears_IsConvertedAgain) {
  ServiceHarness service;
  service.start();
  const std::string name = service.add("one");
  ASSERT_TRUE(service.eventually_done(1)) << service.log();
  for (const auto by : {std::chrono::hours(24 * 365 * 20), std::chrono::hours(-24 * 365 * 20)}) {
    const std::size_t before = service.logged(" done ");
    fs::last_write_time(service.in(name + ".raw"), fs::file_time_type::clock::now() + by);
    std::ofstream(service.in(name + ".raw"), std::ios::binary | std::ios::app).flush();  // closed again
    ASSERT_TRUE(ServiceHarness::eventually([&] { return service.logged(" done ") > before; })) << service.log();
  }
  EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
}

}  // namespace
}  // namespace weir::watch_faults_test
