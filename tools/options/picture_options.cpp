#include "tools/options/picture_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/image/colormap.h"

namespace weir {

namespace {

constexpr std::int64_t kMaxEdge = 32768;       // pixels
constexpr std::int64_t kMaxPixels = 1 << 28;   // 3 GiB of picture
constexpr std::int64_t kMaxSamples = 1 << 20;  // the mean is a sum of floats
constexpr std::int64_t kMaxThreads = 4096;
constexpr std::int64_t kMaxDevices = 64;

std::int64_t parse_count(std::string_view option, const std::string& text, std::int64_t low, std::int64_t high) {
  const std::optional<std::int64_t> value = parse_int(text);
  if (!value || *value < low || *value > high) {
    throw usage_error(cat(option, " is \"", text, "\", it must be a whole number from ", low, " to ", high));
  }
  return *value;
}

void parse_size(const std::string& text, RenderOptions& options) {
  const std::vector<std::string> parts = split(text, 'x');
  const auto bad = [&] {
    return usage_error(cat("--size is \"", text, "\", it must be WxH in pixels, each from 1 to ", kMaxEdge, " and ",
                           kMaxPixels, " together"));
  };
  if (parts.size() != 2) throw bad();
  const auto width = parse_int(parts[0]);
  const auto height = parse_int(parts[1]);
  if (!width || !height || *width < 1 || *height < 1 || *width > kMaxEdge || *height > kMaxEdge) throw bad();
  if (*width * *height > kMaxPixels) throw bad();
  options.width = static_cast<std::int32_t>(*width);
  options.height = static_cast<std::int32_t>(*height);
}

// AZIMUTH,ELEVATION[,ZOOM]; everything else about a camera is in a scene.
void parse_camera(const std::string& text, SceneCamera& camera) {
  const std::vector<std::string> parts = split(text, ',');
  std::vector<double> numbers;
  for (const std::string& part : parts) {
    if (const auto number = parse_double(part)) numbers.push_back(*number);
  }
  const bool valid = numbers.size() == parts.size() && (numbers.size() == 2 || numbers.size() == 3) &&
                     std::abs(numbers[0]) <= 3600 && std::abs(numbers[1]) <= 90 &&
                     (numbers.size() == 2 || (numbers[2] >= 0.01 && numbers[2] <= 100));
  if (!valid) {
    throw usage_error(cat("--camera is \"", text, "\", it must be AZIMUTH,ELEVATION[,ZOOM] in degrees,",
                          " elevation from -90 to 90, zoom from 0.01 to 100"));
  }
  camera.position.reset();
  camera.azimuth = numbers[0];
  camera.elevation = numbers[1];
  if (numbers.size() == 3) camera.zoom = numbers[2];
}

void parse_range(const std::string& text, SceneVolume& volume) {
  const std::vector<std::string> parts = split(text, ',');
  std::array<double, 2> range{};
  bool valid = parts.size() == range.size();
  for (std::size_t i = 0; valid && i < range.size(); ++i) {
    const std::optional<double> number = parse_double(parts[i]);
    valid = number && std::abs(*number) <= 3.4e38;
    if (valid) range.at(i) = *number;
  }
  if (!valid || range[0] > range[1]) {
    throw usage_error(cat("--range is \"", text, "\", it must be LOW,HIGH, two numbers that do not fall"));
  }
  volume.range = range;
}

std::vector<int> parse_devices(const std::string& text) {
  std::vector<int> devices;
  for (const std::string& part : split(text, ',')) {
    const std::optional<std::int64_t> number = parse_int(part);
    const bool valid = number && *number >= 0 && *number < kMaxDevices &&
                       std::find(devices.begin(), devices.end(), *number) == devices.end();
    if (!valid) throw usage_error(cat("--devices is \"", text, "\", it must be numbers of CUDA devices, each once"));
    devices.push_back(static_cast<int>(*number));
  }
  return devices;
}

// The scene file first, the command line over it.
Scene make_scene(const PictureArguments& arguments) {
  Scene scene = arguments.scene.empty() ? Scene{} : load_scene(arguments.scene);
  if (!arguments.mode.empty()) scene.mode = parse_render_mode(arguments.mode).value_or(scene.mode);
  if (!arguments.colormap.empty()) {
    scene.volume.colormap = arguments.colormap;
    scene.volume.color.clear();
  }
  if (!arguments.camera.empty()) parse_camera(arguments.camera, scene.camera);
  if (!arguments.range.empty()) parse_range(arguments.range, scene.volume);
  if (!arguments.iso.empty()) {
    const std::optional<double> iso = parse_double(arguments.iso);
    if (!iso || !(std::abs(*iso) <= 3.4e38))
      throw usage_error(cat("--iso is \"", arguments.iso, "\", it must be a number"));
    scene.volume.iso = iso;
  }
  return scene;
}

// Enough that a default picture is clean; the other modes only have edges to smooth.
std::int64_t default_samples(RenderMode mode) { return mode == RenderMode::path ? 32 : 4; }

std::string colormap_list() {
  std::string list;
  for (const std::string_view name : colormap_names()) list += cat(list.empty() ? "" : "|", name);
  return list;
}

}  // namespace

void add_picture_options(CLI::App& command, PictureArguments& arguments) {
  command.add_option("--backend", arguments.backend, "auto, cpu or cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}))
      ->capture_default_str();
  command.add_option("--devices", arguments.devices, "CUDA devices that share the samples")
      ->type_name("N,N,...")
      ->capture_default_str();
  command
      .add_option("--mode", arguments.mode,
                  "path: multiple scattering; dvr: emission and absorption; iso: surface; mip: largest value")
      ->check(CLI::IsMember({"path", "dvr", "iso", "mip"}));
  command.add_option("--size", arguments.size, "in pixels")->type_name("WxH")->capture_default_str();
  command.add_option("--spp", arguments.samples, "samples a pixel; default 32 for path, 4 for the others")
      ->type_name("N");
  command.add_option("--seed", arguments.seed, "of the random numbers; the same seed gives the same picture")
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--scene", arguments.scene, "camera, transfer function, medium, light")->type_name("SCENE.toml");
  command
      .add_option("--filter", arguments.filter,
                  "trilinear; stochastic: one voxel a look-up, drawn by its weight; or nearest")
      ->check(CLI::IsMember({"trilinear", "stochastic", "nearest"}))
      ->capture_default_str();
  command.add_option("--colormap", arguments.colormap, "of the values")->type_name(colormap_list());
  command.add_option("--range", arguments.range, "values at the ends of colours and opacity; default: those there are")
      ->type_name("LOW,HIGH");
  command.add_option("--iso", arguments.iso, "of the surface; default: 35 % of the way from the background")
      ->type_name("VALUE");
  command.add_option("--camera", arguments.camera, "where it stands, in degrees; default 35,20,1")
      ->type_name("AZIMUTH,ELEVATION[,ZOOM]");
  command.add_option("--threads", arguments.threads, "0: all of the machine's")->type_name("N")->capture_default_str();
}

PictureRequest parse_picture(const PictureArguments& arguments) {
  PictureRequest request;
  request.backend = {arguments.backend, parse_devices(arguments.devices),
                     static_cast<int>(parse_count("--threads", arguments.threads, 0, kMaxThreads))};
  request.scene = make_scene(arguments);
  parse_size(arguments.size, request.options);
  const std::map<std::string, Filter> filters{
      {"nearest", Filter::nearest}, {"trilinear", Filter::trilinear}, {"stochastic", Filter::stochastic}};
  request.options.filter = filters.at(arguments.filter);
  request.options.seed = static_cast<std::uint64_t>(parse_count("--seed", arguments.seed, 0, INT64_MAX));
  request.sampling.samples =
      static_cast<std::uint32_t>(arguments.samples.empty() ? default_samples(request.scene.mode)
                                                           : parse_count("--spp", arguments.samples, 1, kMaxSamples));
  request.options.environment = load_environment(request.scene);
  return request;
}

}  // namespace weir
