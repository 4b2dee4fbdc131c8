#include "tools/view/base/view_message.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "format/base/error.h"
#include "tests/support/message_of_error.h"

namespace weir::view_message_test {
namespace {

using Json = nlohmann::json;

Json view() {
  return {{"type", "view"}, {"id", 7},       {"scene", "mode = \"iso\"\n[volume]\niso = 0.5\n"},
          {"width", 320},   {"height", 200}, {"step", 1},
          {"moving", true}};
}

std::string refusal(const Json& message) {
  return message_of_error(ErrorKind::input, [&] { parse_client_message(message.dump(), 2, false); });
}

Json with(const char* key, const Json& value) {
  Json message = view();
  message[key] = value;
  return message;
}

TEST(ViewMessage, View_IsRead) {
  const auto request = std::get<ViewRequest>(parse_client_message(view().dump(), 2, false));
  EXPECT_EQ(request.id, 7);
  EXPECT_EQ(request.width, 320);
  EXPECT_EQ(request.height, 200);
  EXPECT_EQ(request.step, 1U);
  EXPECT_TRUE(request.moving);
  EXPECT_FALSE(request.against);
  EXPECT_EQ(request.scene.mode, RenderMode::iso);
  EXPECT_EQ(request.scene.volume.iso, 0.5);
}

TEST(ViewMessage, WhatIsWrong_IsNamed) {
  EXPECT_EQ(message_of_error(ErrorKind::input, [] { parse_client_message("{", 1, false); }),
            "message: must be a JSON object");
  EXPECT_EQ(message_of_error(ErrorKind::input, [] { parse_client_message("[]", 1, false); }),
            "message: must be a JSON object");
  EXPECT_EQ(refusal({{"type", 3}}), "message: type must be a text");
  EXPECT_EQ(refusal({{"type", "draw"}}), "message: type must be view, shown, probe or convert");
  EXPECT_EQ(refusal(with("width", 0)), "message: width must be a whole number from 1 to 8192");
  EXPECT_EQ(refusal(with("width", 1.5)), "message: width must be a whole number from 1 to 8192");
  EXPECT_EQ(refusal(with("height", 1e300)), "message: height must be a whole number from 1 to 8192");
  EXPECT_EQ(refusal(with("step", 2)), "message: step must be a whole number from 0 to 1");
  EXPECT_EQ(refusal(with("moving", "yes")), "message: moving must be true or false");
  EXPECT_EQ(refusal(with("against", true)), "message: against needs a second file; start weir view with --against");
  EXPECT_EQ(refusal({{"type", "probe"}, {"id", 1}, {"x", 1.5}, {"y", 0}}), "message: x must be a number from 0 to 1");
  EXPECT_EQ(refusal({{"type", "shown"}}), "message: frame is missing");
}

TEST(ViewMessage, WholeNumberAbove2To53_IsNotRounded) {
  const std::int64_t most = std::int64_t{1} << 53;
  EXPECT_EQ(std::get<ViewRequest>(parse_client_message(with("id", most).dump(), 2, false)).id, most);
  const std::string why = "message: id must be a whole number from 0 to 9007199254740992";
  EXPECT_EQ(refusal(with("id", most + 1)), why);
  EXPECT_EQ(refusal(with("id", ~std::uint64_t{0})), why);
  EXPECT_EQ(refusal(with("id", -1)), why);
  EXPECT_EQ(refusal_message(with("id", most + 1).dump(), "no"), R"({"type":"error","view":0,"message":"no"})");
}

TEST(ViewMessage, PictureOfTooManyPixels_IsRefused) {
  Json large = with("width", 8192);
  large["height"] = 8192;
  EXPECT_EQ(refusal(large), "message: width times height is more than 4194304 pixels");
}

TEST(ViewMessage, PicturesOfTwoFiles_CountTogether) {
  Json large = with("width", 2048);
  large["height"] = 1025;
  EXPECT_EQ(std::get<ViewRequest>(parse_client_message(large.dump(), 2, true)).height, 1025);
  large["against"] = true;
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { parse_client_message(large.dump(), 2, true); }),
            "message: width times height is more than 4194304 pixels, of two files");
}

TEST(ViewMessage, SceneThatNamesAFile_IsRefused) {
  EXPECT_EQ(refusal(with("scene", "[lighting]\nenvironment = \"/etc/passwd\"\n")),
            "message: scene names an environment; no page may open files");
  EXPECT_EQ(refusal({{"type", "convert"},
                     {"id", 1},
                     {"rate", 8},
                     {"encoding", "packed"},
                     {"scene", "[lighting]\nenvironment = \"/etc/passwd\"\n"}}),
            "message: scene names an environment; no page may open files");
}

TEST(ViewMessage, SceneThatIsWrong_IsRefusedWithItsPlace) {
  EXPECT_EQ(refusal(with("scene", "mode = \"dream\"\n")),
            "scene:1:8: mode is \"dream\", it must be path, dvr, iso or mip");
}

TEST(ViewMessage, LongPaths_AreCut) {
  const auto request =
      std::get<ViewRequest>(parse_client_message(with("scene", "[volume]\nmax_bounces = 1000000\n").dump(), 2, false));
  EXPECT_EQ(request.scene.volume.max_bounces, kMostViewBounces);
}

TEST(ViewMessage, Convert_TakesKnownEncodingsAlone) {
  const Json message{{"type", "convert"}, {"id", 1}, {"rate", 8}, {"encoding", "--help"}, {"scene", ""}};
  EXPECT_EQ(refusal(message), "message: encoding must be packed or auto");
}

TEST(ViewMessage, Frame_HasItsHeaderFirst) {
  FrameHeader header;
  header.frame = 3;
  header.view = 9;
  header.format = "png";
  header.width = 4;
  header.height = 2;
  header.of = 16;
  const std::array picture{std::byte{0xFF}, std::byte{0x00}, std::byte{0x10}};
  const std::string message = frame_message(header, picture);
  const auto length = static_cast<std::size_t>(static_cast<unsigned char>(message[0])) |
                      static_cast<std::size_t>(static_cast<unsigned char>(message[1])) << 8U;
  EXPECT_EQ(message.substr(2, 2), std::string(2, '\0'));
  const Json json = Json::parse(message.substr(4, length));
  EXPECT_EQ(json["type"], "frame");
  EXPECT_EQ(json["frame"], 3);
  EXPECT_EQ(json["view"], 9);
  EXPECT_EQ(json["format"], "png");
  EXPECT_EQ(json["width"], 4);
  EXPECT_EQ(json["layers"], 1);
  EXPECT_EQ(message.substr(4 + length), std::string("\xFF\x00\x10", 3));
}

TEST(ViewMessage, Error_KeepsWhatIsNoUtf8OutOfTheJson) {
  EXPECT_EQ(error_message(4, "a\xFF"), "{\"type\":\"error\",\"view\":4,\"message\":\"a\xEF\xBF\xBD\"}");
}

TEST(ViewMessage, Refusal_HasTheIdOfWhatIsRefused) {
  EXPECT_EQ(refusal_message(with("width", 0).dump(), "no"), R"({"type":"error","view":7,"id":7,"message":"no"})");
  EXPECT_EQ(refusal_message(R"({"id": 8, "type": "view", "scene": 3})", "no"),
            R"({"type":"error","view":8,"id":8,"message":"no"})");
  EXPECT_EQ(refusal_message(R"({"type": "probe", "id": 3, "x": 2})", "no"),
            R"({"type":"error","view":0,"id":3,"message":"no"})")
      << "a probe is no view";
  EXPECT_EQ(refusal_message(R"({"type": "draw", "id": 9})", "no"),
            R"({"type":"error","view":0,"id":9,"message":"no"})");
}

TEST(ViewMessage, RefusalOfTextThatIsNoJson_HasTheIdThatStandsBeforeTheFault) {
  EXPECT_EQ(refusal_message(R"({"type": "view", "id": 7, "scene": oops})", "no"),
            R"({"type":"error","view":7,"id":7,"message":"no"})");
  EXPECT_EQ(refusal_message(R"({"type": "view", "scene": "a, "id": 7})", "no"),
            R"({"type":"error","view":0,"message":"no"})");
  EXPECT_EQ(refusal_message("\xFF", "no"), R"({"type":"error","view":0,"message":"no"})");
}

TEST(ViewMessage, RefusalOfAMessageWithoutAnId_HasNone) {
  for (const char* text :
       {"{", "[]", "7", R"({"type": "view"})", R"({"type": "view", "id": "7"})", R"({"type": "view", "id": -1})",
        R"({"type": "view", "id": 1.5})", R"({"type": "view", "id": 18446744073709551615})",
        R"({"type": "view", "id": {"id": 7}})", R"({"type": "view", "id": [7]})", R"([{"type": "view", "id": 7}])"}) {
    EXPECT_EQ(refusal_message(text, "no"), R"({"type":"error","view":0,"message":"no"})") << text;
  }
}

}  // namespace
}  // namespace weir::view_message_test
