// Tests what a page asks about the conversion for a scene, with a real server.
#include "tools/view/convert/scene_requests.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "format/base/text.h"
#include "format/sidecar/sidecar.h"
#include "tests/tools/support/converted_volume.h"
#include "tests/tools/view/served_view.h"
#include "tests/tools/view/view_client.h"

namespace weir::scene_requests_test {
namespace {

using Json = nlohmann::json;

class SceneRequestsTest : public ConvertedVolume {};

TEST_F(SceneRequestsTest, Convert_ShowsTheCommandAndRunsItOnlyWhereAllowed) {
  ServedView served(volume_);
  ViewClient client(served.port());
  client.show(1, true);
  Json request{{"type", "convert"}, {"id", 1}, {"scene", "mode = \"mip\"\n"}, {"rate", 4}, {"encoding", "packed"}};
  client.send(request);
  const Json shown = client.text("conversion").value();
  EXPECT_EQ(shown["state"], "shown");
  EXPECT_EQ(shown["bytes"], 40 * 30 * 20) << "a quarter of the float32 bytes";
  EXPECT_EQ(shown["command"],
            cat("weir convert ", directory_ / "v_40x30x20_float32.raw", " --encoding packed --rate 4 -o ",
                directory_ / "v_scene.nvdb", " --scene scene.toml"));
  request["run"] = true;
  client.send(request);
  const Json failed = client.text("conversion").value();
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_EQ(failed["message"], "this server runs no conversion; start it with --allow-convert");
  EXPECT_FALSE(std::filesystem::exists(directory_ / "v_scene.nvdb"));
}

TEST_F(SceneRequestsTest, Convert_IsForecast) {
  ViewSettings settings;
  settings.program = WEIR_COMMAND;
  ServedView served(volume_, "", settings);
  ViewClient client(served.port());
  const std::string scene = "mode = \"dvr\"\n[volume]\nrange = [0, 250]\nopacity = [[0, 0], [0.5, 0], [1, 1]]\n";
  write_file(directory_ / "s.toml", scene);
  Json request{{"type", "convert"}, {"id", 1}, {"scene", scene}, {"psnr", 45}, {"encoding", "packed"}};
  client.send(request);
  EXPECT_TRUE(client.text("conversion").value()["bytes"].is_null());
  const Json forecast = client.text("forecast").value();
  EXPECT_EQ(forecast["state"], "done") << forecast;
  EXPECT_EQ(forecast["id"], 1);
  // The file as the conversion makes it.
  const std::string made = directory_ / "made.nvdb";
  ASSERT_EQ(run_weir({"convert", directory_ / "v_40x30x20_float32.raw", "--encoding", "packed", "--psnr", "45",
                      "--scene", directory_ / "s.toml", "-o", made})
                .exit_code,
            0);
  const Sidecar sidecar = read_sidecar(sidecar_path(made));
  EXPECT_EQ(forecast["exact"], true);
  EXPECT_EQ(forecast["bytes"]["value"], sidecar.file.bytes);
  EXPECT_EQ(forecast["psnr_db"]["value"], sidecar.error.psnr_db.value());
  EXPECT_EQ(forecast["max_abs"], sidecar.error.max_abs);
  EXPECT_FALSE(std::filesystem::exists(directory_ / "v_scene.nvdb"));
  request["id"] = 2;
  request["scene"] = "mode = \"dvr\"\n";
  client.send(request);
  const Json failed = client.text("forecast").value();
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_NE(failed["message"].get<std::string>().find("opacity"), std::string::npos) << failed;
}

TEST_F(SceneRequestsTest, Convert_WithoutMemoryForForecasts_SaysSo) {
  ViewSettings settings;
  settings.forecast = false;
  ServedView served(volume_, "", settings);
  ViewClient client(served.port());
  client.send({{"type", "convert"}, {"id", 1}, {"scene", ""}, {"rate", 4}, {"encoding", "packed"}});
  EXPECT_EQ(
      client.text("forecast").value()["message"],
      "no memory is set aside for a forecast here, run the command with --dry-run; --forecast-memory of weir view, or "
      "192 MiB of viewer_memory of weir watch, has one made");
}

TEST_F(SceneRequestsTest, Convert_OfASourceThatIsAnother_IsRefused) {
  const std::string source = directory_ / "v_40x30x20_float32.raw";
  const std::string mtime = sidecar().source.mtime;
  std::filesystem::resize_file(source, 100);
  ServedView served(volume_);
  ViewClient client(served.port());
  client.send({{"type", "convert"}, {"id", 1}, {"scene", ""}, {"rate", 4}, {"encoding", "packed"}});
  const Json failed = client.text("conversion").value();
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_TRUE(failed["command"].is_null());
  EXPECT_EQ(failed["message"], cat(source, ": is not the source of ", volume_, ", which had 96000 bytes as of ", mtime,
                                   "; put it there, or convert it again from where it is"));
}

TEST_F(SceneRequestsTest, Convert_IsOfTheStepThatIsAsked) {
  const std::string steps = directory_ / "steps";
  std::filesystem::create_directory(steps);
  for (const char* name : {"/v_1.nvdb", "/v_2.nvdb"}) {
    std::filesystem::copy(volume_, steps + name);
    std::filesystem::copy(sidecar_path(volume_), sidecar_path(steps + name));
  }
  ServedView served(steps);
  ViewClient client(served.port());
  client.show(1, true);
  client.send({{"type", "convert"}, {"id", 1}, {"step", 1}, {"scene", ""}, {"rate", 4}, {"encoding", "packed"}});
  const Json shown = client.text("conversion").value();
  EXPECT_EQ(shown["step"], 1);
  EXPECT_NE(shown["command"].get<std::string>().find("v_2_scene.nvdb"), std::string::npos) << shown;
}

TEST_F(SceneRequestsTest, SecondRun_IsRefusedWithItsCommand) {
  ViewSettings settings;
  settings.allow_convert = true;
  settings.program = directory_ / "program";
  write_file(settings.program, "#!/bin/sh\nexec sleep 60\n");
  std::filesystem::permissions(settings.program, std::filesystem::perms(0755));
  ServedView served(volume_, "", settings);
  ViewClient client(served.port());
  Json request{{"type", "convert"}, {"id", 1}, {"scene", ""}, {"rate", 4}, {"encoding", "packed"}, {"run", true}};
  client.send(request);
  const Json first = client.text("conversion").value();
  EXPECT_EQ(first["state"], "running");
  request["id"] = 2;
  client.send(request);
  const Json second = client.text("conversion").value();
  EXPECT_EQ(second["state"], "failed");
  EXPECT_EQ(second["message"], "a conversion runs already; wait for its end");
  EXPECT_EQ(second["command"], first["command"]);
  EXPECT_EQ(second["bytes"], first["bytes"]);
}

TEST_F(SceneRequestsTest, Convert_MakesTheFileWhereAllowed) {
  ViewSettings settings;
  settings.allow_convert = true;
  settings.program = WEIR_COMMAND;
  ServedView served(volume_, "", settings);
  ViewClient client(served.port());
  for (const std::string& made : {directory_ / "v_scene.nvdb", directory_ / "v_scene_2.nvdb"}) {
    client.send({{"type", "convert"},
                 {"id", 1},
                 {"scene", "mode = \"dvr\"\n[volume]\nrange = [0, 250]\nopacity = [[0, 0], [1, 1]]\n"},
                 {"rate", 4},
                 {"encoding", "packed"},
                 {"run", true}});
    EXPECT_EQ(client.text("conversion").value()["state"], "running");
    const Json done = client.text("conversion").value();
    EXPECT_EQ(done["state"], "done") << done;
    EXPECT_EQ(done["message"], made);
    EXPECT_TRUE(std::filesystem::exists(made));
  }
}

}  // namespace
}  // namespace weir::scene_requests_test
