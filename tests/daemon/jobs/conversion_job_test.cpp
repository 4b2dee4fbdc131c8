// Tests one job with the real `weir`: its report for every way in which it can end.
#include "daemon/jobs/conversion_job.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "format/base/text.h"
#include "tests/daemon/support/one_conversion_job.h"
#include "tests/support/run_command.h"

namespace weir::conversion_job_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

using ConversionJobTest = OneConversionJob;

TEST_F(ConversionJobTest, KeepsToItsBandwidth) {
  ConversionTask limited = task(write_source("a_128x128x128_uint8.raw", 128 << 14U));
  limited.thumbnails = false;
  limited.bandwidth = 4 << 20U;
  const TaskReport report = run(limited);
  EXPECT_EQ(report.end, TaskEnd::done) << report.result.reason;
  const std::uint64_t moved = report.result.bytes_read + report.result.bytes_written;
  EXPECT_GT(report.result.seconds, 0.75 * static_cast<double>(moved) / static_cast<double>(limited.bandwidth));
}

TEST_F(ConversionJobTest, CertifiedGradient_IsAThirdPassAndNoStepBack) {
  ConversionTask work = task(write_source("a_128x128x128_uint8.raw", 128 << 14U));
  work.thumbnails = false;
  work.bandwidth = 8 << 20U;
  work.convert_options = {"--certify=gradient"};
  std::vector<double> fractions;
  const TaskReport report = run(work, [&](ConversionJob& job) {
    if (job.step() == "convert" && job.fraction()) fractions.push_back(*job.fraction());
  });
  ASSERT_EQ(report.end, TaskEnd::done) << report.result.reason;
  ASSERT_FALSE(fractions.empty());
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  EXPECT_GE(fractions.front(), 0);
  EXPECT_LE(fractions.back(), 1);
  const auto record = nlohmann::json::parse(read_file(report.result.outputs.at(0).path + ".json"));
  EXPECT_EQ(record["error"]["gradient"]["voxels"], 128 << 14U);
}

TEST_F(ConversionJobTest, StoppedProcess_IsTheReasonGivenForAStall) {
  ConversionTask slow = task(write_source("a_128x128x128_uint8.raw", 128 << 14U));
  slow.thumbnails = false;
  slow.bandwidth = 4 << 20U;
  std::string stall;
  const TaskReport report = run(slow, [&](ConversionJob& job) {
    if (!stall.empty() || !job.fraction()) return;
    EXPECT_EQ(job.stall(std::chrono::seconds(60), std::chrono::seconds(0)), "");
    job.look();
    std::ifstream children(cat("/proc/self/task/", ::gettid(), "/children"));
    pid_t child = 0;
    ASSERT_TRUE(children >> child);
    ::kill(child, SIGSTOP);
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    stall = job.stall(std::chrono::seconds(1), std::chrono::seconds(60));
    ::kill(child, SIGCONT);
  });
  EXPECT_EQ(report.end, TaskEnd::done) << report.result.reason;
  EXPECT_TRUE(stall.starts_with("nothing done by convert for ")) << stall;
  EXPECT_TRUE(stall.ends_with(" s: it was stopped by a signal; SIGCONT lets it go on")) << stall;
}

// For example, libhdf5 loops forever in a damaged heap.
TEST_F(ConversionJobTest, ProcessThatComputesAndSaysNothing_IsAStall) {
  ConversionTask endless = task(write_source("a_8x8x8_uint8.raw", 512));
  endless.program = directory_ / "weir";
  write_file(endless.program, "#!/bin/sh\nwhile :; do :; done\n");
  fs::permissions(endless.program, fs::perms::owner_all);
  boost::asio::io_context io;
  ConversionJob job(io, endless, [](const TaskReport&) {});
  EXPECT_EQ(job.stall(std::chrono::seconds(60), std::chrono::seconds(60)), "");
  EXPECT_EQ(
      job.stall(std::chrono::seconds(60), std::chrono::seconds(0)),
      "convert computes for 0 s and has not begun to read values: the file may be damaged, cancel the job to end it");
}

TEST_F(ConversionJobTest, LosslessOverValidVoxelsAlone_HasAnInfinitePsnr) {
  ConversionTask work = task(write_source("a_48x40x32_uint8.raw", 48 * 40 * 32));
  work.convert_options = {"--lossless", "--missing=1", "--missing-policy=background"};
  const TaskReport report = run(work, [](ConversionJob&) {});
  ASSERT_EQ(report.end, TaskEnd::done) << report.result.reason;
  EXPECT_EQ(report.result.outputs.at(0).max_error, 0.0);
  EXPECT_EQ(report.result.outputs.at(0).psnr_db, HUGE_VAL);
}

TEST_F(ConversionJobTest, ConvertsVerifiesAndRendersOnce) {
  const std::string source = write_source("a_48x40x32_uint8.raw", 48 * 40 * 32);
  const std::string output = directory_ / "out/a_48x40x32_uint8.nvdb";
  std::string steps;
  const TaskReport first = run(task(source), [&](ConversionJob& job) {
    if (!steps.ends_with(cat(job.step(), ' '))) steps += cat(job.step(), ' ');
    EXPECT_LE(job.fraction().value_or(0), 1);
  });
  EXPECT_EQ(first.end, TaskEnd::done) << first.result.reason;
  EXPECT_EQ(steps, "convert verify render ");
  EXPECT_TRUE(first.converted);
  ASSERT_EQ(first.result.outputs.size(), 1U);
  EXPECT_EQ(first.result.outputs[0].path, output);
  EXPECT_EQ(first.result.outputs[0].bytes, fs::file_size(output));
  EXPECT_EQ(first.result.outputs[0].thumbnail, output + ".png");
  EXPECT_GT(first.result.outputs[0].psnr_db, 0.0);
  EXPECT_EQ(first.result.bytes_written, fs::file_size(output));
  EXPECT_GE(first.result.bytes_read, std::uint64_t{48 * 40 * 32});
  EXPECT_GT(first.result.peak_rss_bytes, 0U);
  EXPECT_EQ(first.notices, Names{});
  EXPECT_EQ(list_directory(directory_ / "out"),
            (Names{"a_48x40x32_uint8.nvdb", "a_48x40x32_uint8.nvdb.json", "a_48x40x32_uint8.nvdb.png"}));

  ASSERT_TRUE(first_report_);
  EXPECT_EQ(first_report_->end, TaskEnd::done);
  EXPECT_TRUE(first_report_->converted);
  EXPECT_EQ(first_report_->result.outputs.at(0).path, output);
  EXPECT_EQ(first_report_->result.outputs[0].thumbnail, "");

  const auto written = fs::last_write_time(output + ".png");
  const TaskReport second = run(task(source));
  EXPECT_EQ(second.end, TaskEnd::done);
  EXPECT_FALSE(second.converted);
  EXPECT_FALSE(first_report_);  // no thumbnail is due
  EXPECT_EQ(second.result.bytes_written, 0U);
  EXPECT_EQ(second.result.outputs, first.result.outputs);
  EXPECT_EQ(fs::last_write_time(output + ".png"), written);
}

TEST_F(ConversionJobTest, FailedConversion_GivesTheMessageOfConvert) {
  const std::string source = write_source("short_48x40x32_uint8.raw", 1000);
  const TaskReport report = run(task(source));
  EXPECT_EQ(report.end, TaskEnd::failed);
  EXPECT_EQ(report.result.exit_code, 3);
  EXPECT_TRUE(report.result.reason.starts_with(source + ": ")) << report.result.reason;
  EXPECT_NE(report.result.log_tail.find(cat("weir: ", source, ": ")), std::string::npos);
  EXPECT_EQ(list_directory(directory_ / "out"), Names{});
}

TEST_F(ConversionJobTest, FailedConversion_NamesOptionsAsTheConfigurationDoes) {
  ConversionTask missing = task(write_source("a_48x40x32_uint8.raw", 48 * 40 * 32));
  missing.convert_options = {"--missing=1"};
  const TaskReport report = run(missing);
  EXPECT_EQ(report.end, TaskEnd::failed);
  EXPECT_EQ(report.result.exit_code, 3);
  EXPECT_NE(report.result.reason.find("missing_policy background"), std::string::npos) << report.result.reason;
  EXPECT_EQ(report.result.reason.find("--"), std::string::npos) << report.result.reason;
}

TEST_F(ConversionJobTest, ChangedSource_EndsAsSourceChanged) {
  const std::string source = write_source("a_48x40x32_uint8.raw", 48 * 40 * 32);
  ConversionTask stale = task(source);
  ++stale.identity.mtime_ns;
  EXPECT_EQ(run(stale).end, TaskEnd::source_changed);
  fs::resize_file(source, 10);  // an attempt that fails for this reason does not count
  EXPECT_EQ(run(stale).end, TaskEnd::source_changed);
}

// The header, which is the watched file, stays unchanged.
TEST_F(ConversionJobTest, DataFileRewrittenDuringConversion_EndsAsSourceChanged) {
  write_source("a.bin", 128 << 14U);
  write_file(directory_ / "a.nhdr",
             "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 128 128 128\nencoding: raw\ndata file: a.bin\n");
  ConversionTask limited = task(directory_ / "a.nhdr");
  limited.bandwidth = 4 << 20U;
  bool rewritten = false;
  const TaskReport report = run(limited, [&](ConversionJob& job) {
    if (rewritten || !job.fraction()) return;
    rewritten = true;
    fs::last_write_time(directory_ / "a.bin", fs::last_write_time(directory_ / "a.bin") + std::chrono::hours(1));
  });
  EXPECT_TRUE(rewritten);
  EXPECT_EQ(report.end, TaskEnd::source_changed);
  EXPECT_EQ(report.result.exit_code, 3);
  EXPECT_TRUE(report.result.reason.starts_with(directory_ / "a.bin: changed while it was read: it was written to at "))
      << report.result.reason;
  EXPECT_EQ(list_directory(directory_ / "out"), Names{});
}

TEST_F(ConversionJobTest, MissingSource_EndsAsSourceGone) {
  EXPECT_EQ(run(task(directory_ / "a_48x40x32_uint8.raw")).end, TaskEnd::source_gone);
}

TEST_F(ConversionJobTest, ADamagedOutputIsRemovedAndMadeAgainByTheNextAttempt) {
  const std::string source = write_source("a_48x40x32_uint8.raw", 48 * 40 * 32);
  const std::string output = directory_ / "out/a_48x40x32_uint8.nvdb";
  ASSERT_EQ(run(task(source)).end, TaskEnd::done);
  {
    std::fstream file(output, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(-1, std::ios::end).put('x');  // in the padding: only the digest shows the change
  }
  const TaskReport damaged = run(task(source));
  EXPECT_EQ(damaged.end, TaskEnd::failed);
  EXPECT_EQ(damaged.result.exit_code, 5);
  EXPECT_TRUE(damaged.result.reason.starts_with("verify: " + output + ": sidecar file.digest: found "))
      << damaged.result.reason;
  EXPECT_FALSE(fs::exists(output));
  const TaskReport again = run(task(source));
  EXPECT_EQ(again.end, TaskEnd::done);
  EXPECT_TRUE(again.converted);
}

// A file of sysfs cannot be mapped. A file server that fails for a moment has the same effect.
TEST_F(ConversionJobTest, OutputThatVerifyCannotRead_StaysAndTheAttemptFails) {
  const ConversionTask work = task(write_source("a_48x40x32_uint8.raw", 48 * 40 * 32));
  ConversionTask disturbed = work;
  disturbed.program = directory_ / "weir.sh";
  write_file(disturbed.program, cat("#!/bin/sh\n[ $1 = verify ] && exec ", work.program, " verify ",
                                    directory_ / "unreadable.nvdb", "\nexec ", work.program, " \"$@\"\n"));
  fs::permissions(disturbed.program, fs::perms::owner_all);
  fs::create_symlink("/sys/devices/system/cpu/online", directory_ / "unreadable.nvdb");
  const TaskReport report = run(disturbed);
  EXPECT_EQ(report.end, TaskEnd::failed);
  EXPECT_EQ(report.result.exit_code, 5) << report.result.reason;
  EXPECT_FALSE(run(work).converted) << "volume and sidecar are there";
}

TEST_F(ConversionJobTest, StopsWhenAsked) {
  const std::string source = directory_ / "zeros_1024x1024x512_uint8.raw";
  write_file(source, "");
  fs::resize_file(source, std::uintmax_t{1} << 29U);
  bool asked = false;
  const TaskReport report = run(task(source), [&](ConversionJob& job) {
    if (!job.fraction() || asked) return;
    EXPECT_GT(job.resident_bytes(), 0U);
    asked = true;
    job.stop(std::chrono::seconds(20));
  });
  EXPECT_EQ(report.end, TaskEnd::stopped);
  EXPECT_EQ(report.result.exit_code, 130);
  EXPECT_EQ(list_directory(directory_ / "out"), Names{});
}

TEST_F(ConversionJobTest, KilledProcess_FailsAndNamesTheSignal) {
  ConversionTask killed = task(write_source("a_48x40x32_uint8.raw", 48 * 40 * 32));
  killed.program = directory_ / "weir";
  write_file(killed.program, "#!/bin/sh\nkill -9 $$\n");
  fs::permissions(killed.program, fs::perms::owner_all);
  const TaskReport report = run(killed);
  EXPECT_EQ(report.end, TaskEnd::failed);
  EXPECT_EQ(report.result.exit_code, 137);
  EXPECT_EQ(report.result.reason, "convert was ended by signal 9 (Killed); the system may have been out of memory");
}

TEST_F(ConversionJobTest, OutputDirectoryCannotBeMade_FailsWithExitCode5) {
  const std::string source = write_source("a_48x40x32_uint8.raw", 48 * 40 * 32);
  write_file(directory_ / "file", "");
  ConversionTask below = task(source);
  below.output = directory_ / "file/out/";
  const TaskReport report = run(below);
  EXPECT_EQ(report.end, TaskEnd::failed);
  EXPECT_EQ(report.result.exit_code, 5);
  EXPECT_EQ(report.result.reason, (directory_ / "file/out") + ": make the directory: Not a directory");
}

TEST_F(ConversionJobTest, KilledOrFailedRender_IsRepeatedOnce) {
  const ConversionTask plain = task(write_source("a_48x40x32_uint8.raw", 48 * 40 * 32));
  const std::string program = directory_ / "weir.sh";
  const std::string mark = directory_ / "ended";
  for (const std::string end : {"kill -9 $$", "exit 5"}) {
    SCOPED_TRACE(end);
    fs::remove_all(directory_ / "out");
    fs::remove(mark);
    write_file(program, cat("#!/bin/sh\nif [ \"$1\" = render ] && [ ! -e ", mark, " ]; then touch ", mark, "; ", end,
                            "; fi\nexec ", plain.program, " \"$@\"\n"));
    fs::permissions(program, fs::perms::owner_all);
    ConversionTask disturbed = plain;
    disturbed.program = program;
    const TaskReport report = run(disturbed);
    EXPECT_EQ(report.end, TaskEnd::done);
    EXPECT_TRUE(fs::exists(mark));
    EXPECT_EQ(report.notices, Names{});
    ASSERT_EQ(report.result.outputs.size(), 1U);
    EXPECT_TRUE(fs::exists(report.result.outputs[0].thumbnail));
  }
}

TEST_F(ConversionJobTest, RenderThatFailsTwice_LeavesTheJobDoneWithANotice) {
  ConversionTask failing = task(write_source("a_48x40x32_uint8.raw", 48 * 40 * 32));
  const std::string program = directory_ / "weir.sh";
  write_file(program, cat("#!/bin/sh\nif [ \"$1\" = render ]; then echo weir: no >&2; exit 5; fi\nexec ",
                          failing.program, " \"$@\"\n"));
  fs::permissions(program, fs::perms::owner_all);
  failing.program = program;
  const TaskReport report = run(failing);
  EXPECT_EQ(report.end, TaskEnd::done);
  EXPECT_EQ(report.notices, Names{"no thumbnail: no"});
  ASSERT_EQ(report.result.outputs.size(), 1U);
  EXPECT_EQ(report.result.outputs[0].thumbnail, "");
}

TEST_F(ConversionJobTest, RenderThatCannotStart_LeavesTheJobDone) {
  ConversionTask lost = task(write_source("a_48x40x32_uint8.raw", 48 * 40 * 32));
  const std::string program = directory_ / "weir.sh";
  write_file(program,
             "#!/bin/sh\nif [ \"$1\" = verify ]; then rm " + program + "; fi\nexec " + lost.program + " \"$@\"\n");
  fs::permissions(program, fs::perms::owner_all);
  lost.program = program;
  const TaskReport report = run(lost);
  EXPECT_EQ(report.end, TaskEnd::done);
  EXPECT_EQ(report.result.exit_code, 0);
  EXPECT_EQ(report.notices, Names{cat("no thumbnail: ", program, ": cannot start it: No such file or directory")});
}

TEST_F(ConversionJobTest, SourceChangedBeforeTheVerification_HasNoThumbnail) {
  const std::string source = write_source("a_48x40x32_uint8.raw", 48 * 40 * 32);
  bool rewritten = false;
  const TaskReport report = run(task(source), [&](ConversionJob& job) {
    if (rewritten || job.step() != "verify") return;
    rewritten = true;
    fs::last_write_time(source, fs::last_write_time(source) + std::chrono::hours(1));
  });
  EXPECT_EQ(report.end, TaskEnd::source_changed);
  EXPECT_FALSE(first_report_);
  EXPECT_FALSE(fs::exists(directory_ / "out/a_48x40x32_uint8.nvdb.png"));
}

}  // namespace
}  // namespace weir::conversion_job_test
