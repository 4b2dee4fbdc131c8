// Tests the server of weir view with several files: steps, new steps, and two files side by side.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "format/base/text.h"
#include "ingest/files/numbered_series.h"
#include "tests/tools/support/converted_volume.h"
#include "tests/tools/view/served_view.h"
#include "tests/tools/view/view_client.h"
#include "tools/view/view_server.h"

namespace weir::view_series_test {
namespace {

using Json = nlohmann::json;
using std::chrono::milliseconds;

class ViewSeriesTest : public ConvertedVolume {
 protected:
  /// Makes a volume of 24 x 20 x 16 values from 0 to `most`; the second value is infinite if `infinite`.
  std::string ramp(const std::string& name, float most, bool infinite = false) {
    const std::string raw = directory_ / "w_24x20x16_float32.raw";
    std::vector<float> values(24 * 20 * 16);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = most * static_cast<float>(i) / (24 * 20 * 16 - 1);
    if (infinite) values[1] = std::numeric_limits<float>::infinity();
    write_file(raw, std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)));
    std::vector<std::string> command{"convert", raw, "-o", directory_ / name, "--lossless"};
    if (infinite) command.insert(command.end(), {"--nonfinite", "keep", "--encoding", "float"});
    EXPECT_EQ(run_weir(command).exit_code, 0);
    return directory_ / name;
  }
};

TEST_F(ViewSeriesTest, Series_ShowsEachStep) {
  const std::string second = directory_ / "v2.nvdb";
  std::filesystem::copy(volume_, second);
  std::filesystem::copy(sidecar_path(volume_), sidecar_path(second));
  ServedView served(directory_.path().string());
  ViewClient client(served.port());
  EXPECT_EQ(Json::parse(get(served.port(), "/api/state").second)["steps"], Json::parse("[\"v.nvdb\", \"v2.nvdb\"]"));
  client.show(1, true, {{"step", 1}});
  EXPECT_EQ(client.frame().value().header["step"], 1);
}

TEST_F(ViewSeriesTest, GrowingSeries_TellsNewStepsAndThoseThatAreGone) {
  ViewSettings settings;
  settings.look_again = milliseconds(30);
  const std::string wide = ramp("w.nvdb", 1000);  // more values than those of volume_
  std::filesystem::create_directory(directory_ / "steps");
  const auto step = [&](int number) { return cat(directory_ / "steps", "/s_", number, ".nvdb"); };
  std::filesystem::copy(volume_, step(2));
  ServedView served(directory_ / "steps", "", settings);
  ViewClient client(served.port());
  const Json facts = client.text("facts").value();
  EXPECT_EQ(Json::parse(get(served.port(), "/api/state").second)["grows"], true);

  write_file(step(3), "no volume yet");
  std::filesystem::copy(volume_, step(1));
  Json told = client.text("steps").value();
  EXPECT_EQ(told["steps"], Json::parse(R"(["s_2.nvdb", "s_1.nvdb"])")) << "a file that is not whole is no step";
  EXPECT_EQ(told["order"], Json::parse("[1, 0]"));
  EXPECT_EQ(told["range"], facts["range"]);

  std::filesystem::copy(wide, step(3), std::filesystem::copy_options::overwrite_existing);
  told = client.text("steps").value();
  EXPECT_EQ(told["order"], Json::parse("[1, 0, 2]"));
  EXPECT_EQ(told["range"][1], 1000);
  EXPECT_EQ(told["opacity"].size(), 33U);
  client.show(1, true, {{"step", 2}});
  const ReceivedFrame third = client.frame().value();
  EXPECT_EQ(third.header["step"], 2);
  client.taken(third);

  std::filesystem::remove(step(1));
  told = client.text("steps").value();
  EXPECT_EQ(told["order"], Json::parse("[0, 2]"));
  client.show(2, true, {{"step", 1}});
  EXPECT_EQ(client.text("error").value()["message"], cat(step(1), ": cannot open: No such file or directory"));
  client.show(3, true, {{"step", 0}});
  EXPECT_EQ(client.frame().value().header["step"], 0) << "the server goes on";
}

TEST_F(ViewSeriesTest, StepThatBecomesReadableOrIsReplaced_WidensTheRange) {
  ViewSettings settings;
  settings.look_again = milliseconds(30);
  std::filesystem::create_directory(directory_ / "steps");
  const auto step = [&](int number) { return cat(directory_ / "steps", "/s_", number, ".nvdb"); };
  std::filesystem::copy(volume_, step(1));
  write_file(step(2), "no volume yet");
  ServedView served(directory_ / "steps", "", settings);
  ViewClient client(served.port());
  const Json facts = client.text("facts").value();
  EXPECT_LT(facts["range"][1], 1000);
  std::filesystem::rename(ramp("w.nvdb", 1000), step(2));
  Json told = client.text("steps").value();
  EXPECT_EQ(told["order"], Json::parse("[0, 1]"));
  EXPECT_EQ(told["range"], Json::parse(cat("[", facts["range"][0].dump(), ", 1000.0]")));
  std::filesystem::rename(ramp("x.nvdb", 2000), step(1));
  told = client.text("steps").value();
  EXPECT_EQ(told["range"][1], 2000);
}

TEST_F(ViewSeriesTest, SingleFileThatIsReplaced_HasItsOwnRange) {
  ServedView served(volume_);
  ViewClient client(served.port());
  EXPECT_NE(client.text("facts").value()["range"][1], 7);
  std::filesystem::rename(ramp("w.nvdb", 7), volume_);
  client.show(1, true);
  EXPECT_EQ(client.text("facts").value()["range"], Json::parse("[0, 7]"));
}

TEST_F(ViewSeriesTest, FileWithInfinities_HasTheRangeOfItsFiniteValues) {
  const std::string path = ramp("w.nvdb", 7, true);
  const auto range = [&] {
    ServedView served(path);
    return ViewClient(served.port()).text("facts").value()["range"];
  };
  ASSERT_FALSE(std::isfinite(NvdbFile(path).grid().value_max()));
  EXPECT_EQ(range(), Json::parse("[0, 7]"));
  ServedView served(path);
  EXPECT_EQ(ViewClient(served.port()).text("facts").value()["values"], Json::parse(R"([0, "inf"])"));
  std::filesystem::remove(sidecar_path(path));
  EXPECT_EQ(range(), Json::parse("[0, 7]")) << "by the macrocells";
}

TEST_F(ViewSeriesTest, StepWithInfinities_WidensTheRangeByItsFiniteValues) {
  std::filesystem::create_directory(directory_ / "steps");
  const auto step = [&](int number) { return cat(directory_ / "steps", "/s_", number, ".nvdb"); };
  std::filesystem::rename(ramp("w.nvdb", 7), step(1));
  const std::string kept = ramp("x.nvdb", 30, true);
  std::filesystem::rename(kept, step(2));
  std::filesystem::rename(sidecar_path(kept), sidecar_path(step(2)));
  std::filesystem::rename(ramp("y.nvdb", 40, true), step(3));  // without its certificate
  ServedView served(directory_ / "steps");
  EXPECT_EQ(ViewClient(served.port()).text("facts").value()["range"], Json::parse("[0, 40]"));
  std::filesystem::remove(step(3));
  ServedView fewer(directory_ / "steps");
  EXPECT_EQ(ViewClient(fewer.port()).text("facts").value()["range"], Json::parse("[0, 30]"));
}

TEST_F(ViewSeriesTest, StepsOfOneBaseName_AreNamedWithTheirFolders) {
  ViewSettings settings;
  settings.look_again = milliseconds(30);
  const auto run = [&](const std::string& letter) {
    std::filesystem::create_directory(directory_ / ("run" + letter));
    std::filesystem::copy(volume_, directory_ / ("run" + letter) + "/out.nvdb");
  };
  run("A");
  ServedView served(directory_ / "run*/out.nvdb", "", settings);
  ViewClient client(served.port());
  EXPECT_EQ(client.text("facts").value()["file"], "out.nvdb");
  run("B c");
  const Json names = Json::parse(R"(["runA/out.nvdb", "runB c/out.nvdb"])");
  EXPECT_EQ(client.text("steps").value()["steps"], names);
  EXPECT_EQ(Json::parse(get(served.port(), "/api/state").second)["steps"], names);
  client.show(1, true, {{"step", 0}});
  EXPECT_EQ(client.text("facts").value()["file"], names[0]) << "of the same file, by its new name";
  client.show(2, true, {{"step", 1}});
  const Json second = client.text("facts").value();
  EXPECT_EQ(second["file"], names[1]);
  EXPECT_EQ(second["word"], "'runB c/out.nvdb'");
}

TEST_F(ViewSeriesTest, FirstStepThatCannotBeRead_IsSaidAndAnotherIsTold) {
  std::filesystem::create_directory(directory_ / "steps");
  const auto step = [&](int number) { return cat(directory_ / "steps", "/s_", number, ".nvdb"); };
  write_file(step(1), "no volume");
  write_file(step(2), "no volume");
  std::filesystem::copy(volume_, step(3));
  ServedView served(directory_ / "steps");
  ViewClient client(served.port());
  const Json error = client.text("error").value();
  EXPECT_TRUE(error["message"].get<std::string>().starts_with(step(1) + ": ")) << error;
  const auto facts = client.text("facts");
  ASSERT_TRUE(facts);
  EXPECT_EQ((*facts)["step"], 2);
  EXPECT_EQ((*facts)["file"], "s_3.nvdb");
}

TEST_F(ViewSeriesTest, FileThatBecomesReadable_IsToldToWhoWaits) {
  ViewSettings settings;
  settings.look_again = milliseconds(30);
  const std::string path = directory_ / "later.nvdb";
  write_file(path, "no volume");
  ServedView served(path, "", settings);
  ViewClient client(served.port());
  ASSERT_TRUE(client.text("error"));
  std::filesystem::rename(volume_, path);
  const auto facts = client.text("facts");
  ASSERT_TRUE(facts);
  EXPECT_EQ((*facts)["file"], "later.nvdb");
}

TEST_F(ViewSeriesTest, SeriesOfAFile_BeginsAtThatFile) {
  for (const char* name : {"s_1.nvdb", "s_2.nvdb", "s_10.nvdb", "s_2_u.nvdb"}) {
    std::filesystem::copy(volume_, directory_ / name);
  }
  const ViewedFiles files = find_viewed_files({directory_ / "s_2.nvdb", true}, "");
  EXPECT_EQ(files.steps, (std::vector{directory_ / "s_2.nvdb", directory_ / "s_1.nvdb", directory_ / "s_10.nvdb"}));
  EXPECT_TRUE(files.grow);
  EXPECT_FALSE(find_viewed_files({volume_}, "").grow);
  EXPECT_FALSE(find_viewed_files({directory_ / "s_*.nvdb"}, directory_ / "s_*.nvdb").grow) << "a pair each";
}

TEST_F(ViewSeriesTest, PageOfAnotherSeries_IsRefused) {
  std::filesystem::copy(volume_, directory_ / "v_1.nvdb");
  ServedView served(directory_ / "v_1.nvdb");
  const std::string series = Json::parse(get(served.port(), "/api/state").second)["series"];
  EXPECT_EQ(series, viewed_key({directory_ / "v_1.nvdb"}, ""));
  const auto answer = [&](const std::string& key) {
    return upgrade_answer(served.port(), {.target = cat("/ws?series=", key)});
  };
  EXPECT_EQ(answer(series), "101");
  EXPECT_EQ(answer(viewed_key({volume_}, "")), "409 {\"error\":\"this viewer shows another series now: v_1.nvdb\"}\n");
  EXPECT_EQ(viewed_key({directory_ / "v_1.nvdb", true}, ""), viewed_key({directory_ / "v_2.nvdb", true}, ""));
  EXPECT_EQ(viewed_key({directory_ / "v_1.nvdb", true}, ""), series_digest(directory_ / "v_3.nvdb"));
  EXPECT_NE(viewed_key({volume_}, volume_), viewed_key({volume_}, ""));
}

TEST_F(ViewSeriesTest, Against_HasTwoPicturesAboveEachOther) {
  ServedView served(volume_, volume_);
  ViewClient client(served.port());
  client.show(1, false, {{"against", true}});
  const auto frame = client.refined(1, 16);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->header["layers"], 2);
  EXPECT_EQ(frame->header["height"], 48);
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(frame->picture[i])); };
  EXPECT_EQ(byte(22) << 8U | byte(23), 96U) << "the height that the PNG says";
}

TEST_F(ViewSeriesTest, Probe_OfTheOtherFile_TellsItsValueAndThatOfTheFirst) {
  std::vector<float> values(40 * 30 * 20);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 40);  // the largest at x = 39
  const std::string raw = directory_ / "o_40x30x20_float32.raw";
  write_file(raw, std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)));
  ASSERT_EQ(run_weir({"convert", raw, "-o", directory_ / "o.nvdb", "--lossless"}).exit_code, 0);
  ServedView served(volume_, directory_ / "o.nvdb");
  ViewClient client(served.port());
  const std::string along_x = "mode = \"mip\"\n[camera]\nposition = [1000, 14, 9]\nlook_at = [0, 14, 9]\nzoom = 20\n";
  client.show(1, false, {{"scene", along_x}, {"against", true}});
  client.send({{"type", "probe"}, {"id", 3}, {"x", 0.5}, {"y", 0.5}, {"side", 1}});
  const Json other = client.text("value").value();
  EXPECT_EQ(other["voxel"], Json::parse("[39, 14, 9]"));
  EXPECT_EQ(other["value"], 39);
  EXPECT_EQ(other["against"].get<float>(), open().grid().value({39, 14, 9}));
  client.send({{"type", "probe"}, {"id", 4}, {"x", 0.5}, {"y", 0.5}, {"side", 0}});
  const Json first = client.text("value").value();
  const std::vector<std::int64_t> voxel = first["voxel"];
  EXPECT_EQ(first["value"].get<float>(), open().grid().value({voxel[0], voxel[1], voxel[2]}));
  EXPECT_EQ(first["against"], voxel[0]);
}

}  // namespace
}  // namespace weir::view_series_test
