// Tests the report of a job if a file system is full or another process writes its output.
#include <gtest/gtest.h>
#include <sys/mount.h>

#include <cerrno>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/jobs/worker_reason.h"
#include "format/base/text.h"
#include "tests/daemon/support/one_conversion_job.h"
#include "tests/support/run_command.h"
#include "tests/support/scoped_mount.h"

namespace weir::conversion_job_disks_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

using ConversionJobDisksTest = OneConversionJob;

// The message may continue, for example with the place where the work is kept.
TEST_F(ConversionJobDisksTest, FullDiskAndBusyOutput_AreToldByTheErrorsNumberAndPath) {
  ConversionTask full = task(write_source("a_8x8x8_uint8.raw", 512));
  full.program = directory_ / "weir";
  const auto report_of = [&](int error, const std::string& path) {
    const nlohmann::json said{{"failed", "no room; what is done is kept"}, {"errno", error}, {"path", path}};
    write_file(full.program, cat("#!/bin/sh\nfor a; do case $a in --progress-fd=*) fd=${a#*=};; esac; done\n", "echo '",
                                 said.dump(), "' >&$fd\nexit 5\n"));
    fs::permissions(full.program, fs::perms::owner_all);
    return run(full);
  };
  for (const int error : {ENOSPC, EDQUOT}) {
    const TaskReport report = report_of(error, directory_ / "work/.a.nvdb.work/rows");
    EXPECT_EQ(report.end, TaskEnd::disk_full);
    EXPECT_EQ(report.full_directory, directory_ / "work/.a.nvdb.work");
    EXPECT_EQ(report.result.reason, "no room; what is done is kept");
  }
  EXPECT_EQ(report_of(ENOSPC, directory_.path()).full_directory, directory_.path());
  fs::create_directory(directory_ / "spills");  // a spill has no name, so its directory is reported
  EXPECT_EQ(report_of(ENOSPC, directory_ / "spills").full_directory, directory_ / "spills");
  EXPECT_EQ(report_of(ENOSPC, directory_ / "out/.a.nvdb.work").full_directory, directory_ / "out") << "it is gone";
  EXPECT_EQ(report_of(EIO, directory_ / "out/a.nvdb").end, TaskEnd::failed);
  EXPECT_EQ(report_of(EWOULDBLOCK, directory_ / "out/a.nvdb.partial").end, TaskEnd::output_busy);
  EXPECT_EQ(report_of(EWOULDBLOCK, full.source).end, TaskEnd::failed) << "a server that does not answer";
}

// A full disk is no fault of the job, and it may have room later.
TEST_F(ConversionJobDisksTest, OutputDirectoryThatFindsNoRoom_EndsAsDiskFull) {
  const ConversionTask plain = task(write_source("a_8x8x8_uint8.raw", 512));
  fs::create_directory(directory_ / "disk");
  const ScopedMount mount(directory_ / "disk", 1 << 20);
  if (!mount.refused().empty()) GTEST_SKIP() << mount.refused();
  ASSERT_EQ(::mount(nullptr, (directory_ / "disk").c_str(), nullptr, MS_REMOUNT, "nr_inodes=1"), 0);
  ConversionTask full = plain;
  full.output = directory_ / "disk/run/out/";
  const TaskReport report = run(full);
  EXPECT_EQ(report.end, TaskEnd::disk_full);
  EXPECT_EQ(report.full_directory, directory_ / "disk");
  EXPECT_EQ(report.result.exit_code, 5);
  EXPECT_EQ(report.result.reason, (directory_ / "disk/run/out") +
                                      ": make the directory: No space left on device; free space on that file system "
                                      "or choose another with output or work_dir");
}

TEST_F(ConversionJobDisksTest, ThumbnailThatFindsNoRoom_EndsAsDiskFullAndIsNotRepeated) {
  ConversionTask full = task(write_source("a_48x40x32_uint8.raw", 48 * 40 * 32));
  const std::string program = directory_ / "weir.sh";
  const std::string renders = directory_ / "renders";
  for (const std::string said : {"No space left on device", "Disk quota exceeded"}) {
    fs::remove(renders);
    fs::remove_all(directory_ / "out");
    write_file(program, cat("#!/bin/sh\nif [ \"$1\" = render ]; then echo >>", renders,
                            "; echo 'weir: a.png.partial: cannot write 9 bytes at offset 0: ", said,
                            "; free space' >&2; exit 5; fi\nexec ", WEIR_COMMAND, " \"$@\"\n"));
    fs::permissions(program, fs::perms::owner_all);
    full.program = program;
    const TaskReport report = run(full);
    EXPECT_EQ(report.end, TaskEnd::disk_full) << said;
    ASSERT_TRUE(first_report_);
    EXPECT_EQ(first_report_->end, TaskEnd::done) << "the result is there";
    EXPECT_EQ(report.full_directory, directory_ / "out");
    EXPECT_EQ(report.result.reason,
              cat("no thumbnail: a.png.partial: cannot write 9 bytes at offset 0: ", said, "; free space"));
    EXPECT_EQ(report.notices, Names{});
    EXPECT_EQ(read_file(renders), "\n");
  }
}

TEST(WorkerReason, FullDisk_IsToldByTheWordsOfTheSystem) {
  EXPECT_TRUE(says_disk_full("/out/a.png: cannot write: No space left on device"));
  EXPECT_TRUE(says_disk_full("/out/a.png: cannot write: Disk quota exceeded; free space"));
  EXPECT_FALSE(says_disk_full("/out/a.png: cannot write: Input/output error; check the disk or the file server"));
  EXPECT_FALSE(says_disk_full(""));
}

}  // namespace
}  // namespace weir::conversion_job_disks_test
