// Tests weir view from outside: its address, its end, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "format/base/text.h"
#include "tests/support/unreadable_file.h"
#include "tests/tools/support/converted_volume.h"
#include "tests/tools/view/view_client.h"

namespace weir::view_command_test {
namespace {

class ViewCommandTest : public ConvertedVolume {
 protected:
  /// Returns the port of a running command, from the address that it prints.
  static std::uint16_t port_of(ChildProcess& child) {
    for (int i = 0; i < 600 && child.out_so_far().find('\n') == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    const std::string address = child.out_so_far();
    EXPECT_EQ(address.substr(0, 17), "http://127.0.0.1:") << child.err_so_far();
    return address.size() < 18 ? std::uint16_t{0} : static_cast<std::uint16_t>(std::stoi(address.substr(17)));
  }
  void expect_refused(const std::vector<std::string>& arguments, int code, const std::string& message) {
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, code);
    EXPECT_EQ(result.err, cat("weir: ", message, '\n'));
    EXPECT_EQ(result.out, "");
  }
};

TEST_F(ViewCommandTest, Signal_EndsItCleanly) {
  for (const int signal : {SIGINT, SIGTERM}) {
    ChildProcess child({WEIR_COMMAND, "view", volume_});
    const std::uint16_t port = port_of(child);
    ASSERT_NE(port, 0);
    ViewClient client(port);
    client.show(1, false, {{"width", 1600}, {"height", 1200}, {"scene", "mode = \"path\"\n"}});
    ASSERT_TRUE(client.frame());
    child.send_signal(signal);
    const CommandResult result = child.wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
  }
}

// Returns the anonymous memory of a process in MiB, which cannot be dropped like pages of a file.
std::uint64_t anonymous_mib(pid_t process) {
  const std::string status = read_file(cat("/proc/", process, "/status"));
  const std::size_t at = status.find("RssAnon:");
  return at == std::string::npos ? 0 : std::stoull(status.substr(at + 8)) >> 10U;
}

TEST_F(ViewCommandTest, PackedFileLargerThanTheMemory_TurnsBelowTheCeiling) {
  const std::string raw = directory_ / "n_256x256x256_float32.raw";
  ASSERT_EQ(run_weir({"sample", "turbulence", "--dims", "256,256,256", "-o", raw}).exit_code, 0);
  const std::string packed = directory_ / "n.nvdb";
  ASSERT_EQ(run_weir({"convert", raw, "-o", packed, "--encoding", "packed", "--rate", "4"}).exit_code, 0);
  ASSERT_EQ(std::filesystem::file_size(packed), 16U << 20U);
  ChildProcess child({WEIR_COMMAND, "view", packed, "--memory", "8MiB", "--backend", "cpu"});
  const std::uint16_t port = port_of(child);
  ASSERT_NE(port, 0);
  ViewClient client(port);
  std::uint64_t most = 0;
  for (int id = 1; id <= 12; ++id) {
    client.show(
        id, true,
        {{"width", 100}, {"height", 75}, {"scene", cat("mode = \"dvr\"\n[camera]\nazimuth = ", 30 * id, "\n")}});
    const auto frame = client.frame();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->header["view"], id);
    client.taken(*frame);
    most = std::max(most, anonymous_mib(child.pid()));
  }
  client.show(13, false);
  EXPECT_TRUE(client.refined(13, 16));
  most = std::max(most, anonymous_mib(child.pid()));
  EXPECT_GT(most, 0U);
  EXPECT_LE(most, 8U + 16U) << "of voxels, and of the program with its picture; all voxels take 64 MiB";
}

TEST_F(ViewCommandTest, WhatItCannotShow_IsRefused) {
  expect_refused({"view", volume_, "--against", directory_ / "v_*.raw"}, 2,
                 cat(directory_ / "v_40x30x20_float32.raw", ": is no NanoVDB file; convert it first: weir convert ",
                     directory_ / "v_40x30x20_float32.raw"));
  expect_refused({"view", volume_, "--against", directory_ / "none.nvdb"}, 3,
                 cat(directory_ / "none.nvdb", ": cannot open: No such file or directory"));
  std::filesystem::create_directory(directory_ / "empty");
  expect_refused(
      {"view", directory_ / "empty"}, 3,
      cat(directory_ / "empty", ": holds no .nvdb file; weir convert makes them of what it holds: weir convert '",
          directory_ / "empty", "/*' -o ", directory_ / "empty", "/"));
  expect_refused({"view", volume_, "--listen", "foo"}, 2,
                 "--listen: \"foo\" is no address; write HOST:PORT, as 127.0.0.1:8470 or [::1]:8470");
  expect_refused({"view", volume_, "--listen", "0.0.0.0:0"}, 2,
                 "--listen 0.0.0.0:0 can be reached from other machines, so it needs --token-file FILE; or listen on "
                 "127.0.0.1");
  write_file(directory_ / "broken.nvdb", std::string(5000, 'x'));
  EXPECT_EQ(run_weir({"view", directory_ / "broken.nvdb"}).exit_code, 3);
}

TEST_F(ViewCommandTest, MemoryTooSmallForAnyPicture_IsRefused) {
  const std::string too_small =
      ": --memory 100 B is too small to render this grid, which takes 288.1 KiB at least; give --memory 1MiB or more";
  expect_refused({"view", volume_, "--backend", "cpu", "--memory", "100"}, 2, volume_ + too_small);
  const std::string raw = directory_ / "v_40x30x20_float32.raw";
  const CommandResult source =
      run_weir({"view", raw, "--backend", "cpu", "--memory", "100", "--log-level", "error", "--progress", "never"});
  EXPECT_EQ(source.exit_code, 2);
  EXPECT_EQ(source.err.substr(0, source.err.find(" is too small")), cat("weir: ", raw, ": --memory 100 B"));
}

TEST_F(ViewCommandTest, DamagedFirstStep_IsSaidAndTheOthersAreShown) {
  const std::string steps = directory_ / "steps";
  std::filesystem::create_directory(steps);
  write_file(steps + "/s_1.nvdb", "no volume");
  std::filesystem::copy(volume_, steps + "/s_2.nvdb");
  std::filesystem::copy(volume_, steps + "/s_3.nvdb");
  ChildProcess child({WEIR_COMMAND, "view", steps});
  const std::uint16_t port = port_of(child);
  ASSERT_NE(port, 0);
  EXPECT_NE(child.err_so_far().find(cat(steps, "/s_1.nvdb: ")), std::string::npos) << child.err_so_far();
  EXPECT_NE(child.err_so_far().find(cat("; the page begins with ", steps, "/s_2.nvdb\n")), std::string::npos)
      << child.err_so_far();
  ViewClient client(port);
  client.show(1, true, {{"step", 0}});
  EXPECT_EQ(client.frame().value().header["step"], 0);
  const nlohmann::json state = nlohmann::json::parse(get(port, "/api/state").second);
  EXPECT_EQ(state["steps"], nlohmann::json::parse(R"(["s_2.nvdb", "s_1.nvdb", "s_3.nvdb"])"));
  EXPECT_EQ(state["order"], nlohmann::json::parse("[1, 0, 2]"));
  client.show(2, true, {{"step", 1}});
  EXPECT_TRUE(client.text("error").value()["message"].get<std::string>().starts_with(steps + "/s_1.nvdb: "));
}

TEST_F(ViewCommandTest, NoReadableStep_IsRefused) {
  write_file(directory_ / "a_1.nvdb", "no volume");
  write_file(directory_ / "a_2.nvdb", "no volume");
  const CommandResult result = run_weir({"view", directory_ / "a_*.nvdb"});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_TRUE(result.err.starts_with(cat("weir: ", directory_ / "a_2.nvdb", ": "))) << result.err;
}

TEST_F(ViewCommandTest, AFileOfAnotherSuffixIsShownAsItIs) {
  const std::string copy = directory_ / "result.grid";
  std::filesystem::copy_file(volume_, copy);
  ChildProcess child({WEIR_COMMAND, "view", copy, "--against", copy});
  const std::uint16_t port = port_of(child);
  ASSERT_NE(port, 0);
  EXPECT_TRUE(nlohmann::json::parse(get(port, "/api/state").second)["preview_of"].is_null());
  ViewClient client(port);
  EXPECT_TRUE(client.text("facts"));
}

TEST_F(ViewCommandTest, Source_IsShownThroughAConversionThatGoesWithIt) {
  const std::string folder = directory_ / "work";
  std::filesystem::create_directory(folder);
  write_file(directory_ / "dump.bin", read_file(directory_ / "v_40x30x20_float32.raw"));
  ChildProcess child({WEIR_COMMAND, "view", directory_ / "dump.bin", "--dims", "40,30,20", "--type", "float32",
                      "--work-dir", folder, "--progress", "never"});
  const std::uint16_t port = port_of(child);
  ASSERT_NE(port, 0);
  const auto state = nlohmann::json::parse(get(port, "/api/state").second);
  EXPECT_EQ(state["preview_of"], directory_ / "dump.bin");
  EXPECT_EQ(state["render_input"], cat(directory_ / "dump.bin", " --volume dense --dims=40,30,20 --type=float32"));
  const std::string words = state["render_input"];
  const std::string picture = directory_ / "picture.png";
  const CommandResult drawn = run_command(
      {"/bin/sh", "-c", cat("\"$0\" render ", words, " -o \"$1\" --size 32x24 --spp 1"), WEIR_COMMAND, picture});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_EQ(read_file(picture).substr(1, 3), "PNG");
  ViewClient client(port);
  EXPECT_EQ(client.text("facts").value()["grid_type"], "packed");
  client.show(1, true);
  EXPECT_TRUE(client.frame());
  EXPECT_EQ(list_directory(folder).size(), 3U) << "a directory, the file and its sidecar";
  child.send_signal(SIGINT);
  EXPECT_EQ(child.wait().exit_code, 0);
  EXPECT_EQ(list_directory(folder), std::vector<std::string>{});
}

TEST_F(ViewCommandTest, PreviewOfFewValues_IsAsSmallAsItCanBe) {
  const std::string raw = directory_ / "plain_64x64x64_uint8.raw";
  write_file(raw, std::string(std::size_t{64} * 64 * 64, '\3'));
  ChildProcess child({WEIR_COMMAND, "view", raw, "--work-dir", directory_.path(), "--progress", "never"});
  ASSERT_NE(port_of(child), 0);
  child.send_signal(SIGINT);
  const CommandResult result = child.wait();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err.find("padding"), std::string::npos) << result.err;
}

TEST_F(ViewCommandTest, SourceToCompareWith_IsShownWithoutLoss) {
  const std::string folder = directory_ / "work";
  std::filesystem::create_directory(folder);
  write_file(directory_ / "dump.bin", read_file(directory_ / "v_40x30x20_float32.raw"));
  ChildProcess child({WEIR_COMMAND, "view", volume_, "--against", directory_ / "dump.bin", "--dims", "40,30,20",
                      "--type", "float32", "--work-dir", folder, "--progress", "never"});
  const std::uint16_t port = port_of(child);
  ASSERT_NE(port, 0);
  const auto state = nlohmann::json::parse(get(port, "/api/state").second);
  EXPECT_EQ(state["against"], nlohmann::json::parse(R"(["dump.bin.nvdb"])"));
  EXPECT_TRUE(state["preview_of"].is_null());
  ViewClient client(port);
  client.show(1, true, {{"against", true}});
  EXPECT_EQ(client.frame().value().header["layers"], 2);
  const std::vector<std::string> made = list_directory(folder);
  ASSERT_EQ(made.size(), 3U) << "a directory, the file and its sidecar";
  const auto found = std::find_if(made.begin(), made.end(), [](const auto& name) { return name.ends_with(".json"); });
  ASSERT_NE(found, made.end());
  EXPECT_TRUE(read_sidecar((std::filesystem::path(folder) / *found).string()).error.lossless);
  child.send_signal(SIGINT);
  EXPECT_EQ(child.wait().exit_code, 0);
  EXPECT_EQ(list_directory(folder), std::vector<std::string>{});
}

TEST_F(ViewCommandTest, Private_TellsItsTokenAloneToTheProgramThatAsks) {
  const std::string told = directory_ / "told";
  ChildProcess child(
      {"/bin/sh", "-c", "exec \"$0\" view \"$1\" --private --progress-fd 9 9>\"$2\"", WEIR_COMMAND, volume_, told});
  const std::uint16_t port = port_of(child);
  ASSERT_NE(port, 0);
  for (int i = 0; i < 200 && read_file(told).empty(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const auto announced = nlohmann::json::parse(read_file(told));
  EXPECT_EQ(announced["address"], cat("127.0.0.1:", port));
  const std::string token = announced["token"];
  EXPECT_EQ(token.size(), 64U);
  EXPECT_EQ(child.out_so_far().find(token), std::string::npos);
  EXPECT_EQ(get(port, "/api/state").first, 401);
  EXPECT_EQ(get(port, "/api/state", {"node17:8470"}, "Bearer " + token).first, 200) << "whatever the Host";
  EXPECT_EQ(upgrade_answer(port, {.protocols = "weir.view"}).substr(0, 3), "401");
}

TEST_F(ViewCommandTest, PrivateAndSeries_AreRefusedWhereTheyMeanNothing) {
  expect_refused({"view", volume_, "--private"}, 2,
                 "--private tells its token to --progress-fd N alone; give that, too");
  const std::string raw = directory_ / "v_40x30x20_float32.raw";
  expect_refused({"view", raw, "--series", "--progress", "never", "--log-level", "off"}, 2,
                 cat("--series is of a NanoVDB file, and ", raw, " is converted to be seen; leave it out"));
}

TEST_F(ViewCommandTest, SeriesOfAPattern_IsRefused) {
  const std::string pattern = directory_ / "v*.nvdb";
  expect_refused({"view", pattern, "--series"}, 2,
                 cat("--series is of one file, and ", pattern, " is a series by itself; leave it out"));
}

TEST_F(ViewCommandTest, ForecastMemory_IsThatOfAConversion) {
  expect_refused({"view", volume_, "--forecast-memory", "1MiB"}, 2,
                 "--forecast-memory 1MiB must be a size of at least 64.0 MiB, like 512MiB, or 0 for no forecast");
}

TEST_F(ViewCommandTest, Forecast_TakesTheThreadsThatItsMemoryHolds_AndLeavesNothingBehind) {
  const std::string temporary = directory_ / "tmp";
  const std::string work = directory_ / "work";
  for (const std::string& made : {temporary, work}) std::filesystem::create_directory(made);
  CommandOptions options;
  options.environment = {"TMPDIR=" + temporary};
  ChildProcess child({WEIR_COMMAND, "view", volume_, "--threads", "16", "--forecast-memory", "64MiB",
                      "--forecast-bandwidth", "1GB", "--work-dir", work},
                     options);
  const std::uint16_t port = port_of(child);
  ASSERT_NE(port, 0);
  ViewClient client(port);
  client.send({{"type", "convert"},
               {"id", 1},
               {"scene", "mode = \"dvr\"\n[volume]\nrange = [0, 250]\nopacity = [[0, 0], [1, 1]]\n"},
               {"psnr", 45},
               {"encoding", "packed"}});
  const auto forecast = client.text("forecast").value();
  EXPECT_EQ(forecast["state"], "done") << forecast;
  child.send_signal(SIGKILL);
  child.wait();
  EXPECT_EQ(list_directory(temporary), std::vector<std::string>{});
  EXPECT_EQ(list_directory(work), std::vector<std::string>{});
}

TEST_F(ViewCommandTest, ForecastBandwidth_IsThatOfAConversion) {
  expect_refused({"view", volume_, "--forecast-bandwidth", "0"}, 2,
                 "--forecast-bandwidth 0 must be a size above 0, like 200MB (a second)");
}

TEST_F(ViewCommandTest, OptionOfASource_IsRefusedWithAFile) {
  expect_refused({"view", volume_, "--dims", "1,2,3"}, 2,
                 cat("--dims says how to read a source, and ", volume_, " is shown as it is; leave it out"));
}

TEST_F(ViewCommandTest, TokenThatEverybodyCanRead_IsRefused) {
  const std::string token = directory_ / "token";
  write_file(token, "secret\n");
  std::filesystem::permissions(token, std::filesystem::perms(0644));
  expect_refused({"view", volume_, "--token-file", token}, 3, cat(token, ": can be read by everybody; chmod o-r it"));
}

TEST_F(ViewCommandTest, TokenThatMayNotBeRead_ExitsWith5) {
  const std::string token = unreadable_file();
  if (token.empty()) GTEST_SKIP() << "this system has no file that root cannot read";
  expect_refused({"view", volume_, "--token-file", token}, 5,
                 cat(token,
                     ": cannot read: Permission denied; give this user the right to read it and to enter its "
                     "directories"));
}

}  // namespace
}  // namespace weir::view_command_test
