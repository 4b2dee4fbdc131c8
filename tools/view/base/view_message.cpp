#include "tools/view/base/view_message.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "format/base/error.h"
#include "format/base/json_text.h"
#include "format/base/text.h"

namespace weir {
namespace {

[[noreturn]] void refuse_key(std::string_view key, std::string_view why) {
  throw Error(ErrorKind::input, cat("message: ", key, " ", why));
}

const nlohmann::json& value_of(const nlohmann::json& message, const char* key) {
  const auto found = message.find(key);
  if (found == message.end()) refuse_key(key, "is missing");
  return *found;
}

// Returns the integer, signed or unsigned, if it lies in [low, high]. The value is not compared as a double, which
// would round it above 2^53.
std::optional<std::int64_t> integer_within(const nlohmann::json& value, std::int64_t low, std::int64_t high) {
  if (!value.is_number_integer()) return std::nullopt;
  const auto within = [&](auto number) {
    return std::cmp_greater_equal(number, low) && std::cmp_less_equal(number, high);
  };
  const bool fits = value.is_number_unsigned() ? within(value.get<std::uint64_t>()) : within(value.get<std::int64_t>());
  return fits ? std::optional(value.get<std::int64_t>()) : std::nullopt;
}

std::int64_t whole(const nlohmann::json& message, const char* key, std::int64_t low, std::int64_t high) {
  const auto number = integer_within(value_of(message, key), low, high);
  if (!number) refuse_key(key, cat("must be a whole number from ", low, " to ", high));
  return *number;
}

double number(const nlohmann::json& message, const char* key, double low, double high) {
  const nlohmann::json& value = value_of(message, key);
  if (!value.is_number() || !(value.get<double>() >= low && value.get<double>() <= high)) {
    refuse_key(key, cat("must be a number from ", low, " to ", high));
  }
  return value.get<double>();
}

bool flag(const nlohmann::json& message, const char* key) {
  const auto found = message.find(key);
  if (found == message.end()) return false;
  if (!found->is_boolean()) refuse_key(key, "must be true or false");
  return found->get<bool>();
}

std::string text(const nlohmann::json& message, const char* key) {
  const nlohmann::json& value = value_of(message, key);
  if (!value.is_string()) refuse_key(key, "must be a text");
  return value.get<std::string>();
}

std::size_t read_step(const nlohmann::json& message, std::size_t steps) {
  return static_cast<std::size_t>(whole(message, "step", 0, static_cast<std::int64_t>(steps) - 1));
}

constexpr std::int64_t kMostId = std::int64_t{1} << 53;

ProbeRequest read_probe(const nlohmann::json& message, bool against) {
  ProbeRequest probe{whole(message, "id", 0, kMostId), number(message, "x", 0, 1), number(message, "y", 0, 1)};
  if (message.contains("side")) probe.side = static_cast<int>(whole(message, "side", 0, against ? 1 : 0));
  return probe;
}

ViewRequest read_view(const nlohmann::json& message, std::size_t steps, bool against, std::int64_t pixels) {
  ViewRequest view;
  view.id = whole(message, "id", 0, kMostId);
  view.width = static_cast<std::int32_t>(whole(message, "width", 1, kLongestViewEdge));
  view.height = static_cast<std::int32_t>(whole(message, "height", 1, kLongestViewEdge));
  view.step = read_step(message, steps);
  view.moving = flag(message, "moving");
  view.against = flag(message, "against");
  if (view.against && !against) refuse_key("against", "needs a second file; start weir view with --against");
  if (std::int64_t{view.width} * view.height * (view.against ? 2 : 1) > pixels) {
    refuse_key("width", cat("times height is more than ", pixels, " pixels", view.against ? ", of two files" : ""));
  }
  view.scene_text = text(message, "scene");
  view.scene = parse_scene(view.scene_text, "scene");
  if (!view.scene.lighting.environment.empty()) refuse_key("scene", "names an environment; no page may open files");
  if (view.scene.volume.max_bounces > kMostViewBounces) view.scene.volume.max_bounces = kMostViewBounces;
  return view;
}

ConvertRequest read_convert(const nlohmann::json& message, std::size_t steps) {
  ConvertRequest request;
  request.id = whole(message, "id", 0, kMostId);
  request.scene_text = text(message, "scene");
  const Scene scene = parse_scene(request.scene_text, "scene");
  if (!scene.lighting.environment.empty()) refuse_key("scene", "names an environment; no page may open files");
  if (message.contains("psnr")) {
    request.psnr_db = number(message, "psnr", 1, 300);
  } else {
    request.rate = number(message, "rate", 1, 1e6);
  }
  request.encoding = text(message, "encoding");
  if (request.encoding != "packed" && request.encoding != "auto") refuse_key("encoding", "must be packed or auto");
  request.run = flag(message, "run");
  if (message.contains("step")) request.step = read_step(message, steps);
  return request;
}

struct MessageName {
  bool view = false;
  std::optional<std::int64_t> id;
};

// Reads "type" and "id" from a text, up to the point where it is no JSON.
MessageName read_name(std::string_view text_of_message) {
  using Event = nlohmann::json::parse_event_t;
  MessageName name;
  bool object = false;
  std::string key;
  const auto look = [&](int depth, Event event, const nlohmann::json& found) {
    if (depth == 0) object = event == Event::object_start;
    if (depth != 1 || !object) return true;
    if (event == Event::key) {
      key = found.get<std::string>();
    } else if (event == Event::value && key == "type") {
      name.view = found == "view";
    } else if (event == Event::value && key == "id") {
      name.id = integer_within(found, 0, kMostId);
    }
    return true;
  };
  [[maybe_unused]] const nlohmann::json whole_message = nlohmann::json::parse(text_of_message, look, false);
  return name;
}

std::string error_line(std::int64_t view, std::optional<std::int64_t> id, std::string_view message) {
  nlohmann::ordered_json error{{"type", "error"}, {"view", view}};
  if (id) error["id"] = *id;
  error["message"] = message;
  return json_text(error);
}

}  // namespace

ClientMessage parse_client_message(std::string_view text_of_message, std::size_t steps, bool against,
                                   std::int64_t pixels) {
  const nlohmann::json message = nlohmann::json::parse(text_of_message, nullptr, false);
  if (!message.is_object()) throw Error(ErrorKind::input, "message: must be a JSON object");
  const std::string type = text(message, "type");
  if (type == "view") return read_view(message, steps, against, pixels);
  if (type == "shown") return ShownMessage{whole(message, "frame", 0, kMostId)};
  if (type == "probe") return read_probe(message, against);
  if (type == "convert") return read_convert(message, steps);
  refuse_key("type", "must be view, shown, probe or convert");
}

std::string frame_message(const FrameHeader& header, std::span<const std::byte> picture) {
  const std::string json =
      nlohmann::ordered_json{{"type", "frame"},         {"frame", header.frame},     {"view", header.view},
                             {"format", header.format}, {"width", header.width},     {"height", header.height},
                             {"layers", header.layers}, {"samples", header.samples}, {"of", header.of},
                             {"step", header.step},     {"moving", header.moving},   {"render_s", header.render_s}}
          .dump();
  std::string message;
  message.reserve(4 + json.size() + picture.size());
  for (std::size_t i = 0; i < 4; ++i) message += static_cast<char>(json.size() >> (8 * i) & 0xFF);
  message += json;
  message.append(reinterpret_cast<const char*>(picture.data()), picture.size());
  return message;
}

std::string error_message(std::int64_t view, std::string_view message) { return error_line(view, {}, message); }

std::string refusal_message(std::string_view refused, std::string_view message) {
  const MessageName name = read_name(refused);
  return error_line(name.view ? name.id.value_or(0) : 0, name.id, message);
}

}  // namespace weir
