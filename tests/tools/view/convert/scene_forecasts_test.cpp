// Tests forecasts with scripts in place of weir; the tests of the server have a real forecast.
#include "tools/view/convert/scene_forecasts.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::scene_forecasts_test {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFound =
    R"({"exact": false, "sample": {"share": 0.25, "none": null}, "file": {"value": 900.0, "low": 800.0, "high": 1000.0,
        "exact": false}, "error": {"lossless": false, "psnr_db": {"value": 40.5, "low": 39.5, "high": 41.5}, "rmse": 0.1,
        "max_abs": null}, "visible": {"share": 0.125, "lossless": false, "psnr_db": {"value": 50.0, "low": null,
        "high": null}, "rmse": 0.01, "max_abs": null}, "time": {"total_s": 1.5}})";

class SceneForecastsTest : public testing::Test {
 protected:
  struct Told {
    ViewerId viewer;
    Json answer;
  };

  /// Writes a program that appends its scene's first line to `calls` and then runs `then`.
  std::string program(const std::string& then) {
    const std::string path = directory_ / "program";
    write_file(path, cat("#!/bin/sh\nfor word; do [ \"$before\" = --scene ] && head -1 \"$word\" >> ",
                         directory_ / "calls", "; before=$word; done\n", then, "\n"));
    std::filesystem::permissions(path, std::filesystem::perms(0755));
    return path;
  }
  std::string printing_program() {
    write_file(directory_ / "found", kFound);
    return program(cat("cat ", directory_ / "found"));
  }
  SceneConversion conversion() const {
    return {{"convert", directory_ / "source.raw", "-o", "x.nvdb", "--scene", "scene.toml"}, "x.nvdb", "weir convert"};
  }
  void run_while(const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (holds() && std::chrono::steady_clock::now() < end) {
      io_.restart();
      io_.run_for(std::chrono::milliseconds(5));
    }
    ASSERT_FALSE(holds());
  }
  void run_until(std::size_t told) {
    run_while([&] { return told_.size() < told; });
    ASSERT_EQ(told_.size(), told);
  }
  void run_until_called(const std::string& with) {
    run_while([&] { return calls() != with; });
  }
  std::string calls() const {
    return std::filesystem::exists(directory_ / "calls") ? read_file(directory_ / "calls") : "";
  }

  TemporaryDirectory directory_;
  boost::asio::io_context io_;
  std::vector<Told> told_;
  SceneForecasts::Told tell_ = [this](ViewerId viewer, const Json& answer) { told_.push_back({viewer, answer}); };
};

TEST_F(SceneForecastsTest, SameQuestion_IsWorkedOnOnce) {
  SceneForecasts forecasts(io_, printing_program(), {}, tell_);
  forecasts.ask(1, 7, conversion(), "a\n");
  forecasts.ask(2, 8, conversion(), "a\n");
  run_until(2);
  EXPECT_EQ(told_[0].answer,
            Json::parse(R"({"type": "forecast", "id": 7, "state": "done", "exact": false, "share": 0.25,
      "none": null, "bytes": {"value": 900.0, "low": 800.0, "high": 1000.0, "exact": false}, "lossless": false,
      "psnr_db": {"value": 40.5, "low": 39.5, "high": 41.5}, "max_abs": null, "visible": {"lossless": false,
      "psnr_db": {"value": 50.0, "low": null, "high": null}, "share": 0.125}, "total_s": 1.5})"));
  EXPECT_EQ(told_[1].viewer, 2);
  EXPECT_EQ(told_[1].answer["id"], 8);
  forecasts.ask(1, 9, conversion(), "a\n");
  ASSERT_EQ(told_.size(), 3U) << "it is known";
  EXPECT_EQ(told_[2].answer["id"], 9);
  EXPECT_EQ(calls(), "a\n");
  write_file(directory_ / "source.raw", "another source");
  forecasts.ask(1, 10, conversion(), "a\n");
  run_until(4);
  EXPECT_EQ(calls(), "a\na\n");
}

TEST_F(SceneForecastsTest, Options_AreThoseOfTheConversion) {
  SceneForecasts forecasts(io_, program("echo \"$@\" > " + (directory_ / "words") + "; exit 1"),
                           {"--memory=67108864", "--threads=3"}, tell_);
  forecasts.ask(1, 1, conversion(), "a\n");
  run_until(1);
  EXPECT_TRUE(read_file(directory_ / "words").ends_with(" --dry-run --json --quiet --memory=67108864 --threads=3\n"))
      << read_file(directory_ / "words");
}

TEST_F(SceneForecastsTest, NewerQuestion_EndsTheOlder_AndOfAViewerThatIsGone) {
  SceneForecasts forecasts(io_, program("exec sleep 60"), {}, tell_);
  forecasts.ask(1, 1, conversion(), "a\n");
  forecasts.ask(2, 2, conversion(), "b\n");
  run_until_called("a\n");
  printing_program();
  forecasts.forget(1);
  run_until(1);
  EXPECT_EQ(told_[0].viewer, 2);
  EXPECT_EQ(told_[0].answer["state"], "done");
  program("exec sleep 60");
  forecasts.ask(1, 3, conversion(), "c\n");
  run_until_called("a\nb\nc\n");
  printing_program();
  forecasts.ask(1, 4, conversion(), "d\n");
  run_until(2);
  EXPECT_EQ(told_[1].answer["id"], 4);
}

TEST_F(SceneForecastsTest, QuestionsInQuickSuccession_StartOneProcess) {
  SceneForecasts forecasts(io_, printing_program(), {}, tell_);
  for (const char* scene : {"a\n", "b\n", "c\n"}) forecasts.ask(1, 1, conversion(), scene);
  run_until(1);
  EXPECT_EQ(calls(), "c\n");
}

TEST_F(SceneForecastsTest, NextOne_BeginsWhenTheLastHasEnded) {
  const std::string lock = directory_ / "lock";
  // The program takes a while to remove its files.
  SceneForecasts forecasts(
      io_,
      program(cat("trap 'sleep 0.05; rmdir ", lock, "; exit 1' TERM; mkdir ", lock, "; while :; do sleep 0.01; done")),
      {}, tell_);
  forecasts.ask(1, 1, conversion(), "a\n");
  run_while([&] { return !std::filesystem::exists(lock); });
  write_file(directory_ / "found", kFound);
  program(cat("mkdir ", lock, " && cat ", directory_ / "found"));
  forecasts.ask(1, 2, conversion(), "b\n");
  run_until(1);
  EXPECT_EQ(told_[0].answer["id"], 2);
  EXPECT_EQ(told_[0].answer["state"], "done") << told_[0].answer;
}

TEST_F(SceneForecastsTest, OutputWithoutTheFiguresOfOneVolume_IsAFailure) {
  SceneForecasts forecasts(io_, program("echo '{\"steps\": []}'"), {}, tell_);
  forecasts.ask(1, 1, conversion(), "a\n");
  run_until(1);
  EXPECT_EQ(told_[0].answer, Json::parse(R"({"type": "forecast", "id": 1, "state": "failed",
                                             "message": "weir convert --dry-run gave no figures of one volume"})"));
}

TEST_F(SceneForecastsTest, Failure_IsTriedAgain) {
  SceneForecasts forecasts(io_, program("exit 3"), {}, tell_);
  forecasts.ask(1, 1, conversion(), "a\n");
  run_until(1);
  EXPECT_EQ(told_[0].answer["state"], "failed");
  printing_program();
  forecasts.ask(1, 2, conversion(), "a\n");
  run_until(2);
  EXPECT_EQ(told_[1].answer["state"], "done");
}

TEST_F(SceneForecastsTest, MemoryThatIsTooLittle_IsSaidInWhatItsReaderCanSet) {
  SceneForecasts forecasts(io_,
                           program("echo 'weir: --memory 64.0 MiB is too small for this volume with 1 thread; give at "
                                   "least 71MiB' >&2; exit 2"),
                           {}, tell_);
  forecasts.ask(1, 1, conversion(), "a\n");
  run_until(1);
  EXPECT_EQ(told_[0].answer["message"],
            "the memory set aside for a forecast is too little for this volume, it needs 71MiB; give more by "
            "--forecast-memory of weir view, or by viewer_memory of weir watch, of which it is a share");
}

TEST_F(SceneForecastsTest, Failure_IsSaidInTheProgramsWords) {
  SceneForecasts forecasts(io_, program("echo 'weir: x.raw: open: No such file or directory' >&2; exit 3"), {}, tell_);
  forecasts.ask(1, 1, conversion(), "a\n");
  run_until(1);
  EXPECT_EQ(told_[0].answer, Json::parse(R"({"type": "forecast", "id": 1, "state": "failed",
                                             "message": "x.raw: open: No such file or directory"})"));
  SceneForecasts none(io_, directory_ / "none", {}, tell_);
  none.ask(1, 2, conversion(), "a\n");
  run_until(2);
  EXPECT_EQ(told_[1].answer["message"], cat(directory_ / "none", ": cannot start it: No such file or directory"));
}

}  // namespace
}  // namespace weir::scene_forecasts_test
