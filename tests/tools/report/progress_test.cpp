#include "tools/report/progress.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <array>
#include <memory>
#include <stdexcept>
#include <string>

namespace weir::progress_test {
namespace {

/// A temporary stream, and a clock that the test sets.
struct Stage {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> out{std::tmpfile(), std::fclose};
  double now_s = 100.0;

  std::function<double()> clock() {
    return [this] { return now_s; };
  }
  std::string text() const {
    std::string all;
    std::rewind(out.get());
    for (int c = std::fgetc(out.get()); c != EOF; c = std::fgetc(out.get())) all += static_cast<char>(c);
    return all;
  }
};

TEST(ProgressText, ShareRateAndTimeLeft) {
  EXPECT_EQ(progress_text("survey", 2'000'000'000, 8'000'000'000, 2.0), "survey 25 % of 7.5 GiB, 1.00 GB/s, 0:06 left");
  EXPECT_EQ(progress_text("encode", 1, 10001, 1.0), "encode 0 % of 9.8 KiB, 0.00 GB/s, 2:46:40 left");
  EXPECT_EQ(progress_text("encode", 1, 101, 1.0), "encode 0 % of 101 B, 0.00 GB/s, 1:40 left");
}

TEST(ProgressText, SamplesAreCountedInMillions) {
  EXPECT_EQ(progress_text("render", 11'000'000, 44'000'000, 10.0, ProgressUnit::samples),
            "render 25 % of 44.0 M samples, 1.10 M/s, 0:30 left");
}

TEST(ProgressText, NothingDoneHasNoRate) { EXPECT_EQ(progress_text("survey", 0, 100, 3.0), "survey 0 % of 100 B"); }

TEST(ProgressText, NoTimePassedHasNoRate) { EXPECT_EQ(progress_text("survey", 5, 100, 0.0), "survey 5 % of 100 B"); }

TEST(ProgressText, CompleteHasNoTimeLeft) {
  EXPECT_EQ(progress_text("survey", 100, 100, 1e-6), "survey 100 % of 100 B, 0.10 GB/s");
}

TEST(ProgressText, MoreThanTheTotal_IsShownAs100Percent) {
  EXPECT_EQ(progress_text("survey", 300, 100, 1e-6), "survey 100 % of 100 B, 0.10 GB/s");
}

TEST(ProgressText, EmptyPassIsComplete) { EXPECT_EQ(progress_text("encode", 0, 0, 1.0), "encode 100 % of 0 B"); }

TEST(Progress, WithoutATerminal_PrintsALineEveryFiveSeconds) {
  Stage stage;
  Progress progress(ProgressMode::automatic, stage.out.get(), stage.clock());
  progress.start("survey", 1000);
  stage.now_s += 4.9;
  progress.update(100);
  stage.now_s += 0.1;
  progress.update(500);
  stage.now_s += 4.0;
  progress.update(900);
  progress.finish();
  EXPECT_EQ(stage.text(), "weir: survey 50 % of 1000 B, 0.00 GB/s, 0:05 left\n");
}

TEST(Progress, ModeAlways_EndsEveryPassWithALine) {
  Stage stage;
  Progress progress(ProgressMode::always, stage.out.get(), stage.clock());
  progress.start("survey", 1000);
  progress.start("encode", 10);  // finishes the survey
  progress.finish();
  progress.finish();  // once only
  EXPECT_EQ(stage.text(), "weir: survey 100 % of 1000 B\nweir: encode 100 % of 10 B\n");
}

TEST(Progress, ModeNever_PrintsNothing) {
  Stage stage;
  Progress progress(ProgressMode::never, stage.out.get(), stage.clock());
  progress.start("survey", 1000);
  stage.now_s += 60;
  progress.update(500);
  progress.finish();
  EXPECT_EQ(stage.text(), "");
}

TEST(Progress, BarOnATerminalEndsItsLineWhenWorkThrows) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) GTEST_SKIP() << "no pseudo-terminal here";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(ptsname(terminal), "w"), std::fclose);
  ASSERT_NE(out, nullptr);
  double now_s = 0.0;
  try {
    Progress progress(ProgressMode::automatic, out.get(), [&] { return now_s; });
    progress.start("survey", 1000);
    now_s = 1.0;
    progress.update(250);
    throw std::runtime_error("work failed");
  } catch (const std::runtime_error&) {
  }
  std::string shown;
  std::array<char, 512> bytes{};
  while (!shown.ends_with('\n')) {
    const ssize_t count = read(terminal, bytes.data(), bytes.size());
    ASSERT_GT(count, 0) << shown;
    shown.append(bytes.data(), static_cast<std::size_t>(count));
  }
  close(terminal);
  EXPECT_EQ(shown, "\r\x1b[K[######..................] survey 25 % of 1000 B, 0.00 GB/s, 0:03 left\r\n");
}

TEST(Progress, WritesJsonLinesToTheGivenDescriptor) {
  Stage stage;
  Stage pipe;
  ProgressOptions options(ProgressMode::never);
  options.descriptor = fileno(pipe.out.get());
  {
    Progress progress(options, stage.out.get(), stage.clock());
    progress.start("survey", 1000);
    stage.now_s += 0.09;
    progress.update(100);  // too soon
    stage.now_s += 0.02;
    progress.update(300);
    progress.start("encode", 20, ProgressUnit::samples);
    progress.update(40);
  }
  announce(options, "{}");
  EXPECT_EQ(pipe.text(),
            "{\"pass\":\"survey\",\"done\":0,\"total\":1000,\"unit\":\"bytes\"}\n"
            "{\"pass\":\"survey\",\"done\":300,\"total\":1000,\"unit\":\"bytes\"}\n"
            "{\"pass\":\"survey\",\"done\":1000,\"total\":1000,\"unit\":\"bytes\"}\n"
            "{\"pass\":\"encode\",\"done\":0,\"total\":20,\"unit\":\"samples\"}\n"
            "{}\n");
  EXPECT_EQ(stage.text(), "");
}

TEST(Progress, ProgressOptionTakesTheNamesOfTheModes) {
  ProgressOptions options;
  CLI::App app;
  add_progress_options(app, options);
  app.parse("--progress never");
  EXPECT_EQ(options.mode, ProgressMode::never);
  app.parse("--progress always");
  EXPECT_EQ(options.mode, ProgressMode::always);
  EXPECT_THROW(app.parse("--progress often"), CLI::ValidationError);
}

}  // namespace
}  // namespace weir::progress_test
