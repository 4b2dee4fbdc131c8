// The messages between a page and the server over the WebSocket of `weir view`. Texts are JSON objects with a key
// "type"; a picture is one binary message. docs/view.md describes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "format/sidecar/scene.h"

namespace weir {

/// Identifies a connected page.
using ViewerId = std::int64_t;

/// The most pixels of a picture, both files of a comparison together. The sums take 12 bytes per pixel, and a pass
/// that made room for another page takes 16 more.
inline constexpr std::int64_t kMostViewPixels = 4 << 20;
inline constexpr std::int32_t kLongestViewEdge = 8192;  ///< pixels
/// The most collisions of a path, so that one pixel does not keep all others waiting.
inline constexpr int kMostViewBounces = 1024;

/// "view": what the server shows from now on.
struct ViewRequest {
  std::int64_t id = 0;     ///< chosen by the client, sent back with each picture
  std::string scene_text;  ///< TOML as `weir render --scene` takes it
  Scene scene;             ///< `scene_text`, parsed
  std::int32_t width = 0;  ///< pixels of the still picture
  std::int32_t height = 0;
  std::size_t step = 0;
  bool moving = false;   ///< the view moves: another view follows at once
  bool against = false;  ///< two pictures, one above the other: the file and the file it is compared with
};

/// "shown": the client has shown the picture, so the next picture may be sent.
struct ShownMessage {
  std::int64_t frame = 0;
};

/// "probe": asks for the value under a point of the picture.
struct ProbeRequest {
  std::int64_t id = 0;
  double x = 0;  ///< in [0, 1], from the left
  double y = 0;  ///< in [0, 1], from the top
  int side = 0;  ///< 1: in the picture of the file that is compared with
};

/// "convert": asks for the command that converts the source for a scene and its forecast, or runs the command.
struct ConvertRequest {
  std::int64_t id = 0;
  std::string scene_text;
  std::string encoding;        ///< "packed" or "auto"
  std::optional<double> rate;  ///< size of the file, as `weir convert --rate` takes it
  double psnr_db = 0;          ///< used without a rate: least PSNR of what the scene shows, dB
  bool run = false;
  std::optional<std::size_t> step;  ///< nullopt: the step of the newest view
};

using ClientMessage = std::variant<ViewRequest, ShownMessage, ProbeRequest, ConvertRequest>;

/// Parses a client's message. `pixels`: the most pixels of a picture. Throws Error(input) that names the key first and
/// then the fault. A scene that names a file (an environment) is refused, because only the command line may name
/// files.
ClientMessage parse_client_message(std::string_view text, std::size_t steps, bool against,
                                   std::int64_t pixels = kMostViewPixels);

/// The header that is sent with a picture.
struct FrameHeader {
  std::int64_t frame = 0;  ///< number of the picture, per viewer
  std::int64_t view = 0;   ///< ViewRequest::id
  std::string format;      ///< "jpeg" or "png"
  std::int32_t width = 0;  ///< of one layer, pixels
  std::int32_t height = 0;
  int layers = 1;             ///< pictures stacked one above the other
  std::uint32_t samples = 0;  ///< samples per pixel so far
  std::uint32_t of = 0;       ///< samples per pixel of the converged picture
  std::size_t step = 0;
  bool moving = false;
  double render_s = 0;  ///< duration of this pass, seconds
};

/// Returns the message: the length of the header in four bytes, little-endian; the header as JSON; the picture.
std::string frame_message(const FrameHeader& header, std::span<const std::byte> picture);

/// Returns {"type": "error", "view": id, "message": message}.
std::string error_message(std::int64_t view, std::string_view message);

/// Returns an error message for a client's message that is refused. "view" is the id of a refused view, otherwise 0;
/// "id" is the id of any message and is absent if none is found. Both are also searched in text that is not JSON, up
/// to the point where parsing fails.
std::string refusal_message(std::string_view refused, std::string_view message);

}  // namespace weir
