// Tests the server of weir view over loopback, with clients that are no browsers.
#include "tools/view/view_server.h"

#include <gtest/gtest.h>

#include <boost/asio/write.hpp>
#include <filesystem>
#include <thread>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/tools/support/converted_volume.h"
#include "tests/tools/view/served_view.h"
#include "tests/tools/view/view_client.h"
#include "tools/view/jpeg_picture.h"

namespace weir::view_server_test {
namespace {

using Json = nlohmann::json;
using std::chrono::milliseconds;

class ViewServerTest : public ConvertedVolume {
 protected:
  static void wait_for_viewers(ServedView& served, std::size_t viewers) {
    for (int i = 0; i < 200 && served.viewers() != viewers; ++i) std::this_thread::sleep_for(milliseconds(50));
    EXPECT_EQ(served.viewers(), viewers);
  }
};

TEST_F(ViewServerTest, MovingView_GetsJpeg_StillView_EndsAsPng) {
  ServedView served(volume_);
  ViewClient client(served.port());
  client.show(1, true);
  const auto moving = client.frame();
  ASSERT_TRUE(moving);
  EXPECT_EQ(moving->header["view"], 1);
  EXPECT_EQ(moving->header["moving"], true);
  EXPECT_EQ(moving->header["format"], has_jpeg() ? "jpeg" : "png");
  EXPECT_EQ(moving->picture.substr(0, 3), has_jpeg() ? "\xFF\xD8\xFF" : "\x89PN");
  client.taken(*moving);
  client.show(2, false);
  const auto still = client.refined(2, 16);
  ASSERT_TRUE(still);
  EXPECT_EQ(still->header["format"], "png");
  EXPECT_EQ(still->header["width"], 64);
  EXPECT_EQ(still->header["height"], 48);
  EXPECT_EQ(still->header["samples"], 16);
  EXPECT_EQ(still->header["of"], 16);
  EXPECT_EQ(still->picture.substr(0, 4), "\x89PNG");
  EXPECT_FALSE(client.frame(milliseconds(300))) << "a converged picture is not drawn again";
}

TEST_F(ViewServerTest, PictureThatIsNotTaken_KeepsTheNextBack) {
  ServedView served(volume_);
  ViewClient client(served.port());
  client.show(1, true);
  const auto first = client.frame();
  ASSERT_TRUE(first);
  for (int id = 2; id <= 20; ++id) client.show(id, true);
  std::this_thread::sleep_for(milliseconds(300));
  client.send({{"type", "probe"}, {"id", 5}, {"x", 0.5}, {"y", 0.5}});
  ASSERT_TRUE(client.text("value"));  // what was sent before it has come
  client.taken(*first);
  const auto second = client.frame();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->header["view"], 20) << "the newest view alone is drawn";
  EXPECT_EQ(second->header["frame"], 2);
}

TEST_F(ViewServerTest, SlowViewer_DelaysNoOther) {
  ServedView served(volume_);
  ViewClient slow(served.port());
  slow.show(1, true);
  ASSERT_TRUE(slow.frame());  // and it never says that it was taken
  slow.show(2, true);
  ViewClient quick(served.port());
  for (int id = 1; id <= 10; ++id) {
    quick.show(id, true);
    const auto frame = quick.frame();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->header["view"], id);
    quick.taken(*frame);
  }
}

TEST_F(ViewServerTest, ViewersShareTheVolumeAndHaveViewsOfTheirOwn) {
  ServedView served(volume_);
  ViewClient one(served.port());
  ViewClient two(served.port());
  one.show(1, false, {{"width", 32}});
  two.show(7, false, {{"width", 40}});
  EXPECT_EQ(one.refined(1, 16).value().header["width"], 32);
  EXPECT_EQ(two.refined(7, 16).value().header["width"], 40);
}

TEST_F(ViewServerTest, Facts_AreTheSidecars) {
  ServedView served(volume_);
  ViewClient client(served.port());
  const Json facts = client.text("facts").value();
  EXPECT_EQ(facts["file"], "v.nvdb");
  EXPECT_EQ(facts["bytes"], 450001);
  EXPECT_EQ(facts["box"], Json::parse("[[0, 0, 0], [40, 30, 20]]"));
  EXPECT_EQ(facts["certificate"]["rate"], sidecar().budget.rate);
  EXPECT_EQ(facts["certificate"]["max_abs"], sidecar().error.max_abs);
  EXPECT_EQ(facts["opacity"].size(), 33U);
  const Json histogram = client.text("histogram").value();
  std::uint64_t counted = 0;
  for (const auto& count : histogram["counts"]) counted += count.get<std::uint64_t>();
  EXPECT_EQ(counted, 40U * 30 * 20);
}

TEST_F(ViewServerTest, FileWithoutASidecar_HasItsHistogramCounted) {
  std::filesystem::remove(sidecar_path(volume_));
  ServedView served(volume_);
  ViewClient client(served.port());
  EXPECT_TRUE(client.text("facts").value()["certificate"].is_null());
  EXPECT_EQ(client.text("histogram").value()["counts"].size(), 256U);
}

TEST_F(ViewServerTest, Probe_TellsTheVoxelUnderThePoint) {
  ServedView served(volume_);
  ViewClient client(served.port());
  const std::string along_x = "mode = \"mip\"\n[camera]\nposition = [1000, 14, 9]\nlook_at = [0, 14, 9]\nzoom = 20\n";
  client.show(1, false, {{"scene", along_x}});
  client.send({{"type", "probe"}, {"id", 3}, {"x", 0.5}, {"y", 0.5}});
  const Json answer = client.text("value").value();
  ASSERT_EQ(answer["found"], true) << answer;
  EXPECT_EQ(answer["id"], 3);
  const NvdbFile file = open();
  float most = 0;
  for (std::int64_t x = 0; x < 40; ++x) most = std::max(most, file.grid().value({x, 14, 9}));
  EXPECT_FLOAT_EQ(answer["value"].get<float>(), most);
  client.send({{"type", "probe"}, {"id", 4}, {"x", 0}, {"y", 0}});
  EXPECT_EQ(client.text("value").value()["found"], false);
}

TEST_F(ViewServerTest, ProbeOfASurface_GoesByThePicturesOwnDefault) {
  ServedView served(volume_);
  ViewClient client(served.port());
  const std::string along_x = "mode = \"iso\"\n[camera]\nposition = [1000, 14, 9]\nlook_at = [0, 14, 9]\nzoom = 20\n";
  client.show(1, false, {{"scene", along_x}});
  client.send({{"type", "probe"}, {"id", 3}, {"x", 0.5}, {"y", 0.5}});
  const Json answer = client.text("value").value();
  ASSERT_EQ(answer["found"], true) << answer;
  const NvdbFile file = open();
  const float surface = 0.35F * file.grid().value_max();  // of values from the background, 0, on
  // Between two voxels along the ray, one on each side of it.
  const std::int64_t x = answer["voxel"][0].get<std::int64_t>();
  const bool above = file.grid().value({x, 14, 9}) >= surface;
  EXPECT_TRUE(x == 39 || (file.grid().value({x + 1, 14, 9}) >= surface) != above) << answer << " " << surface;
}

TEST_F(ViewServerTest, DenseMovingView_KeepsNobodyWaiting) {
  auto served = std::make_unique<ServedView>(volume_);
  const Json dense{
      {"width", 1600}, {"height", 1200}, {"scene", "mode = \"path\"\n[volume]\ndensity = 1e7\nalbedo = 1\n"}};
  ViewClient client(served->port());
  client.show(1, true, dense);
  const auto first = client.frame();
  ASSERT_TRUE(first) << "a picture comes, however small";
  client.taken(*first);
  auto gone = std::make_unique<ViewClient>(served->port());
  gone->show(1, true, dense);
  client.show(2, true, {{"scene", "mode = \"dvr\"\n"}});
  const auto second = client.frame();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->header["view"], 2);
  gone->show(2, true, dense);
  gone.reset();
  const auto begun = std::chrono::steady_clock::now();
  served.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10));
}

TEST_F(ViewServerTest, Histogram_IsCountedForAllWhoWaitForIt) {
  std::filesystem::remove(sidecar_path(volume_));
  ServedView served(volume_);
  std::vector<std::unique_ptr<ViewClient>> clients;
  for (int i = 0; i < 4; ++i) clients.push_back(std::make_unique<ViewClient>(served.port()));
  const std::string first = clients[0]->text("histogram").value().dump();
  for (int i = 1; i < 4; ++i) EXPECT_EQ(clients[static_cast<std::size_t>(i)]->text("histogram").value().dump(), first);
}

TEST_F(ViewServerTest, WorldOfLargeVoxels_IsSeen) {
  const std::string large = directory_ / "l.nvdb";
  const auto made = run_weir(
      {"convert", directory_ / "v_40x30x20_float32.raw", "-o", large, "--lossless", "--spacing", "1e20,1e20,1e20"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  ServedView served(large);
  ViewClient client(served.port());
  const std::string along_x = "mode = \"mip\"\n[camera]\nposition = [1e23, 14e20, 9e20]\nlook_at = [0, 14e20, 9e20]\n";
  client.show(1, true, {{"scene", along_x}});
  EXPECT_EQ(client.frame().value().header["view"], 1);
  client.send({{"type", "probe"}, {"id", 3}, {"x", 0.5}, {"y", 0.5}});
  const Json answer = client.text("value").value();
  EXPECT_EQ(answer["found"], true) << answer;
  EXPECT_EQ(answer["voxel"][1], 14);
}

TEST_F(ViewServerTest, CameraBeyondFloats_IsRefused) {
  ServedView served(volume_);
  ViewClient client(served.port());
  const auto refusal = [&](const std::string& camera) {
    client.show(1, true, {{"scene", "[camera]\n" + camera}});
    return client.text("error").value()["message"].get<std::string>();
  };
  EXPECT_EQ(refusal("position = [0, 2e15, 5]\n"),
            "the camera's position, (0, 2e+15, 5), is farther than 1e+15 voxels from the volume; move it closer");
  EXPECT_EQ(refusal("look_at = [-1e30, 0, 0]\n"),
            "the camera's look_at, (-1e+30, 0, 0), is farther than 1e+15 voxels from the volume; move it closer");
}

TEST_F(ViewServerTest, WrongScene_IsSaidAndTheViewerGoesOn) {
  ServedView served(volume_);
  ViewClient client(served.port());
  client.show(1, true, {{"scene", "mode = \"dream\"\n"}});
  const Json wrong = client.text("error").value();
  EXPECT_EQ(wrong["message"], "scene:1:8: mode is \"dream\", it must be path, dvr, iso or mip");
  EXPECT_EQ(wrong["view"], 1);
  client.show(2, true, {{"scene", "[volume]\ncolormap = \"puce\"\n"}});
  const Json error = client.text("error").value();
  EXPECT_EQ(error["view"], 2);
  EXPECT_NE(error["message"].get<std::string>().find("puce"), std::string::npos) << error;
  client.send({{"type", "probe"}, {"id", 5}, {"x", 2}, {"y", 0}});
  const Json refused = client.text("error").value();
  EXPECT_EQ(refused["message"], "message: x must be a number from 0 to 1");
  EXPECT_EQ(refused["view"], 0);
  EXPECT_EQ(refused["id"], 5);
  client.show(3, true);
  EXPECT_EQ(client.frame().value().header["view"], 3);
}

TEST_F(ViewServerTest, MessageThatIsTooLarge_EndsThatViewerAlone) {
  ServedView served(volume_);
  ViewClient other(served.port());
  ViewClient client(served.port());
  try {
    client.send_text(std::string(100'000, ' '));
  } catch (const boost::system::system_error&) {  // it was ended before all was sent
  }
  EXPECT_TRUE(client.ended());
  wait_for_viewers(served, 1);
  other.show(1, true);
  EXPECT_TRUE(other.frame());
}

TEST_F(ViewServerTest, TooManyMessages_EndThatViewerAlone) {
  ViewSettings settings;
  settings.sockets.burst = 20;
  settings.sockets.messages_per_s = 1;
  ServedView served(volume_, "", settings);
  ViewClient other(served.port());
  ViewClient client(served.port());
  for (int i = 0; i < 40; ++i) client.send({{"type", "shown"}, {"frame", 0}});
  EXPECT_TRUE(client.ended());
  other.show(1, true);
  EXPECT_TRUE(other.frame());
}

TEST_F(ViewServerTest, Garbage_EndsThatViewerAlone) {
  ServedView served(volume_);
  ViewClient other(served.port());
  ViewClient client(served.port());
  boost::asio::write(client.raw(), boost::asio::buffer(std::string(200, '\xFF')));
  EXPECT_TRUE(client.ended());
  ViewClient texts(served.port());
  texts.send_text("{]");
  EXPECT_EQ(texts.text("error").value()["message"], "message: must be a JSON object");
  wait_for_viewers(served, 2);
  other.show(1, true);
  EXPECT_TRUE(other.frame());
}

TEST_F(ViewServerTest, ViewerThatIsGone_LeavesNothing) {
  ServedView served(volume_);
  {
    ViewClient client(served.port());
    client.show(1, false, {{"width", 800}, {"height", 600}, {"scene", "mode = \"path\"\n"}});
    wait_for_viewers(served, 1);
  }  // killed in the middle of a picture
  wait_for_viewers(served, 0);
  ViewClient next(served.port());
  next.show(1, true);
  EXPECT_TRUE(next.frame());
}

TEST_F(ViewServerTest, SilentViewer_IsLeft) {
  ViewSettings settings;
  settings.sockets.idle = milliseconds(400);
  ServedView served(volume_, "", settings);
  ViewClient client(served.port());  // reads nothing, and so answers no ping
  wait_for_viewers(served, 1);
  wait_for_viewers(served, 0);
}

TEST_F(ViewServerTest, ViewerThatTakesNoPicture_IsLeft) {
  ViewSettings settings;
  settings.sockets.taking = milliseconds(300);
  ServedView served(volume_, "", settings);
  ViewClient client(served.port());
  client.show(1, true);
  ASSERT_TRUE(client.frame());
  EXPECT_TRUE(client.ended());
}

TEST_F(ViewServerTest, OneViewerTooMany_IsRefused) {
  ViewSettings settings;
  settings.viewers = 2;
  ServedView served(volume_, "", settings);
  ViewClient one(served.port());
  ViewClient two(served.port());
  wait_for_viewers(served, 2);
  EXPECT_EQ(upgrade_answer(served.port(), {}),
            "503 {\"error\":\"there are 2 pages, as many as there may be; close one\"}\n");
}

TEST_F(ViewServerTest, FileThatIsCut_IsSaidAndTheServerGoesOn) {
  ServedView served(volume_);
  ViewClient client(served.port());
  ASSERT_TRUE(client.text("histogram"));
  client.show(1, true);
  client.taken(client.frame().value());
  std::filesystem::resize_file(volume_, 4096);
  client.show(2, true);
  EXPECT_NE(client.text("error").value()["message"].get<std::string>().find(volume_), std::string::npos);
  client.send({{"type", "probe"}, {"id", 3}, {"x", 0.5}, {"y", 0.5}});
  EXPECT_EQ(client.text("value").value()["found"], false);
}

TEST_F(ViewServerTest, PackedFileLargerThanTheMemory_OpensAndTurns) {
  const std::string raw = directory_ / "n_128x128x128_float32.raw";
  ASSERT_EQ(run_weir({"sample", "turbulence", "--dims", "128,128,128", "-o", raw}).exit_code, 0);
  const std::string packed = directory_ / "n.nvdb";
  ASSERT_EQ(run_weir({"convert", raw, "-o", packed, "--encoding", "packed", "--rate", "8"}).exit_code, 0);
  VoxelMemory memory;
  memory.ceiling = 2 << 20;  // all blocks decoded take 8 MiB
  ServedView served(packed, "", {}, memory);
  ViewClient client(served.port());
  for (int id = 1; id <= 8; ++id) {
    client.show(id, true, {{"scene", cat("mode = \"dvr\"\n[camera]\nazimuth = ", 10 * id, "\n")}});
    const auto frame = client.frame();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->header["view"], id);
    client.taken(*frame);
  }
  client.show(9, false);
  EXPECT_TRUE(client.refined(9, 16));
}

}  // namespace
}  // namespace weir::view_server_test
