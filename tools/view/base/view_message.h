// What a page and the server say to each other over the WebSocket of `weir view`. Texts are JSON objects with a key
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

/// One of the pages that look, for as long as it is connected.
using ViewerId = std::int64_t;

/// Pixels of a picture, of two files together, at most: its sums take 12 bytes each, and a pass that made room for
/// another page 16 more.
inline constexpr std::int64_t kMostViewPixels = 4 << 20;
inline constexpr std::int32_t kLongestViewEdge = 8192;  ///< pixels
/// Collisions of a path, at most: one pixel must not keep all others waiting.
inline constexpr int kMostViewBounces = 1024;

/// "view": what is to be seen from now on.
struct ViewRequest {
  std::int64_t id = 0;     ///< the client's own, comes back with each picture
  std::string scene_text;  ///< TOML as `weir render --scene` takes it
  Scene scene;             ///< the same
  std::int32_t width = 0;  ///< pixels of the picture when it is still
  std::int32_t height = 0;
  std::size_t step = 0;
  bool moving = false;   ///< another view follows at once
  bool against = false;  ///< two pictures, one above the other: the file and the one it is compared with
};

/// "shown": the picture was taken; the next one may come.
struct ShownMessage {
  std::int64_t frame = 0;
};

/// "probe": which value is under a point of the picture.
struct ProbeRequest {
  std::int64_t id = 0;
  double x = 0;  ///< in [0, 1], from the left
  double y = 0;  ///< in [0, 1], from the top
  int side = 0;  ///< 1: of the file that is compared with
};

/// "convert": the command that converts the source for a scene and what it would come to, or its run.
struct ConvertRequest {
  std::int64_t id = 0;
  std::string scene_text;
  std::string encoding;        ///< "packed" or "auto"
  std::optional<double> rate;  ///< the file's size, as `weir convert --rate` has it
  double psnr_db = 0;          ///< where there is no rate: of what the scene shows, at least
  bool run = false;
  std::optional<std::size_t> step;  ///< else the one of the newest view
};

using ClientMessage = std::variant<ViewRequest, ShownMessage, ProbeRequest, ConvertRequest>;

/// `pixels`: of a picture, at most. Throws Error(input) saying what is wrong with the message, the key first. A scene
/// that names a file (an environment) is refused: only the command line names files.
ClientMessage parse_client_message(std::string_view text, std::size_t steps, bool against,
                                   std::int64_t pixels = kMostViewPixels);

/// What comes with a picture.
struct FrameHeader {
  std::int64_t frame = 0;  ///< counts a viewer's pictures
  std::int64_t view = 0;   ///< ViewRequest::id
  std::string format;      ///< "jpeg" or "png"
  std::int32_t width = 0;  ///< of one layer
  std::int32_t height = 0;
  int layers = 1;             ///< pictures above each other
  std::uint32_t samples = 0;  ///< a pixel, so far
  std::uint32_t of = 0;       ///< until it is converged
  std::size_t step = 0;
  bool moving = false;
  double render_s = 0;  ///< of this pass
};

/// The length of the header in four bytes, little-endian; the header as JSON; the picture.
std::string frame_message(const FrameHeader& header, std::span<const std::byte> picture);

/// {"type": "error", "view": id, "message": message}
std::string error_message(std::int64_t view, std::string_view message);

/// The same of a client's message that is refused: "view" is its id where it is a view, else 0, and "id" that of any
/// message. Both are looked for in text that is no JSON, too, up to where it is none; without an id there is no "id".
std::string refusal_message(std::string_view refused, std::string_view message);

}  // namespace weir
