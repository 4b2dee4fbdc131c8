#include "tools/options/picture_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "format/sidecar/colormap_names.h"
#include "tools/options/table_options.h"

namespace weir {

namespace {

constexpr std::int64_t kMaxEdge = 32768;       // pixels
constexpr std::int64_t kMaxPixels = 1 << 28;   // a picture of 3 GiB
constexpr std::int64_t kMaxSamples = 1 << 20;  // the mean is a sum of floats
constexpr std::int64_t kMaxThreads = 4096;
constexpr std::int64_t kMaxDevices = 64;

using Request = PictureRequest;

std::int64_t read_count(const OptionRow& row, const std::string& text, std::int64_t low, std::int64_t high) {
  const std::optional<std::int64_t> value = parse_int(text);
  if (!value || *value < low || *value > high) {
    throw wrong_option(row.key, text, cat("a whole number from ", low, " to ", high));
  }
  return *value;
}

void read_size(const OptionRow& row, const std::string& text, Request& request) {
  const std::vector<std::string> parts = split(text, 'x');
  const auto bad = [&] {
    return wrong_option(row.key, text,
                        cat("WxH in pixels, each from 1 to ", kMaxEdge, " and ", kMaxPixels, " together"));
  };
  if (parts.size() != 2) throw bad();
  const auto width = parse_int(parts[0]);
  const auto height = parse_int(parts[1]);
  if (!width || !height || *width < 1 || *height < 1 || *width > kMaxEdge || *height > kMaxEdge) throw bad();
  if (*width * *height > kMaxPixels) throw bad();
  request.options.width = static_cast<std::int32_t>(*width);
  request.options.height = static_cast<std::int32_t>(*height);
}

// Reads AZIMUTH,ELEVATION[,ZOOM]. Every other camera setting comes from a scene file.
void read_camera(const OptionRow& row, const std::string& text, Request& request) {
  const std::vector<std::string> parts = split(text, ',');
  std::vector<double> numbers;
  for (const std::string& part : parts) {
    if (const auto number = parse_double(part)) numbers.push_back(*number);
  }
  const bool valid = numbers.size() == parts.size() && (numbers.size() == 2 || numbers.size() == 3) &&
                     std::abs(numbers[0]) <= 3600 && std::abs(numbers[1]) <= 90 &&
                     (numbers.size() == 2 || (numbers[2] >= 0.01 && numbers[2] <= 100));
  if (!valid) {
    throw wrong_option(row.key, text,
                       "AZIMUTH,ELEVATION[,ZOOM] in degrees, elevation from -90 to 90, zoom from 0.01 to 100");
  }
  SceneCamera& camera = request.scene.camera;
  camera.position.reset();
  camera.azimuth = numbers[0];
  camera.elevation = numbers[1];
  if (numbers.size() == 3) camera.zoom = numbers[2];
}

// --iso without --mode asks for the surface.
void choose_iso_mode(const GivenOptions& given, Request& request) {
  if (!given.contains("iso") || request.scene.mode == RenderMode::iso) return;
  if (given.contains("mode")) {
    throw Error(ErrorKind::usage, compose(option("iso"), " is of the surface that ", option("mode", "iso"),
                                          " draws; not ", option("mode", render_mode_name(request.scene.mode))));
  }
  request.scene.mode = RenderMode::iso;
}

void check_colorbar(const Request& request) {
  if (!request.colorbar || request.scene.mode != RenderMode::iso) return;
  throw Error(ErrorKind::usage, compose(option("colorbar"), " says which colour is which value, and ",
                                        option("mode", "iso"), " draws the surface of one; leave one of them out"));
}

void check_scattered_levels(const Request& request) {
  const bool scatters = request.options.levels && request.options.levels->scattered > 0;
  if (!scatters || request.scene.mode == RenderMode::path) return;
  throw Error(ErrorKind::usage, compose(option("lod-scattered"), " is of the light that ", option("mode", "path"),
                                        " scatters; not ", option("mode", render_mode_name(request.scene.mode))));
}

bool is_float32(const std::optional<double>& number) { return number && std::abs(*number) <= 3.4e38; }

void read_range(const OptionRow& row, const std::string& text, Request& request) {
  const std::vector<std::string> parts = split(text, ',');
  std::array<double, 2> range{};
  bool valid = parts.size() == range.size();
  for (std::size_t i = 0; valid && i < range.size(); ++i) {
    const std::optional<double> number = parse_double(parts[i]);
    valid = is_float32(number);
    if (valid) range.at(i) = *number;
  }
  if (!valid || range[0] > range[1]) throw wrong_option(row.key, text, "LOW,HIGH, two numbers that do not fall");
  request.scene.volume.range = range;
}

void read_iso(const OptionRow& row, const std::string& text, Request& request) {
  const std::optional<double> iso = parse_double(text);
  if (!is_float32(iso)) throw wrong_option(row.key, text, "a number");
  request.scene.volume.iso = iso;
}

void read_devices(const OptionRow& row, const std::string& text, Request& request) {
  std::vector<int> devices;
  for (const std::string& part : split(text, ',')) {
    const std::optional<std::int64_t> number = parse_int(part);
    const bool valid = number && *number >= 0 && *number < kMaxDevices &&
                       std::find(devices.begin(), devices.end(), *number) == devices.end();
    if (!valid) throw wrong_option(row.key, text, "numbers of CUDA devices, each once");
    devices.push_back(static_cast<int>(*number));
  }
  request.backend.devices = devices;
}

constexpr double kMostBias = 15;  // levels

void read_lod(const OptionRow& row, const std::string& text, Request& request) {
  if (text == "off") return;
  LevelOfDetail levels;
  if (text != "auto") {
    const std::optional<double> bias = parse_double(text);
    if (!bias || !(std::abs(*bias) <= kMostBias)) {
      throw wrong_option(row.key, text, cat("auto, off, or a number of levels from -", kMostBias, " to ", kMostBias));
    }
    levels.bias = static_cast<float>(*bias);
  }
  request.options.levels = levels;
  request.backend.memory.levels = true;
}

// Needs `lod` to be read before; the row of `lod` comes first in the table.
void read_lod_scattered(const OptionRow& row, const std::string& text, Request& request) {
  const std::optional<double> levels = parse_double(text);
  if (!levels || !(*levels >= 0 && *levels <= kMostBias)) {
    throw wrong_option(row.key, text, cat("a number of levels from 0 to ", kMostBias));
  }
  if (*levels == 0) return;
  if (!request.options.levels) {
    throw Error(ErrorKind::usage, compose(option(row.key), " needs ", option("lod", "auto"), " or a number of levels"));
  }
  request.options.levels->scattered = static_cast<float>(*levels);
}

std::uint64_t read_bytes(const OptionRow& row, const std::string& text) {
  const std::optional<std::uint64_t> bytes = parse_bytes(text);
  if (!bytes || *bytes == 0) throw wrong_option(row.key, text, "a size above 0, like 512MiB");
  return *bytes;
}

// Returns the default samples per pixel. Path tracing needs many for a clean picture; the other modes only smooth
// edges.
std::uint32_t default_samples(RenderMode mode) { return mode == RenderMode::path ? 64 : 4; }

// The scene comes first, so that the options after it override it.
constexpr ReadableOption<Request> kPictureOptions[] = {
    {{.key = "scene", .argument = "SCENE.toml", .help = "camera, transfer function, medium, light"},
     [](const OptionRow&, const std::string& text, Request& r) {
       if (!text.empty()) r.scene = load_scene(text);
     }},
    {{.key = "mode",
      .argument = "path|dvr|iso|mip",
      .help = "path: multiple scattering; dvr: emission and absorption; iso: surface; mip: largest value"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.scene.mode =
           std::array{RenderMode::path, RenderMode::dvr, RenderMode::iso, RenderMode::mip}.at(read_choice(row, text));
     }},
    {{.key = "backend",
      .argument = "auto|cpu|cuda",
      .standard = "auto",
      .help = "what renders; auto: cuda where there is a device"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       read_choice(row, text);
       r.backend.name = text;
     }},
    {{.key = "devices", .argument = "N,N,...", .standard = "0", .help = "CUDA devices that share the samples"},
     read_devices},
    {{.key = "size", .argument = "WxH", .unit = "pixels", .standard = "960x720", .help = "in pixels"}, read_size},
    {{.key = "spp", .argument = "N", .standard = "64 for path, 4 for the others", .help = "samples a pixel"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.sampling.samples = static_cast<std::uint32_t>(read_count(row, text, 1, kMaxSamples));
     }},
    {{.key = "seed",
      .argument = "N",
      .standard = "0",
      .help = "of the random numbers; the same seed gives the same picture"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.options.seed = static_cast<std::uint64_t>(read_count(row, text, 0, INT64_MAX));
     }},
    {{.key = "filter",
      .argument = "trilinear|stochastic|nearest",
      .standard = "trilinear",
      .help = "stochastic: one voxel a look-up, drawn by its weight"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.options.filter = std::array{Filter::trilinear, Filter::stochastic, Filter::nearest}.at(read_choice(row, text));
     }},
    {{.key = "colormap", .argument = kColormapNames, .help = "of the values"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       read_choice(row, text);
       r.scene.volume.colormap = text;
       r.scene.volume.color.clear();
     }},
    {{.key = "colorbar",
      .help = "draws a bar of the colours with their values, name and units, right of the picture, "
              "which grows wider by it; .png alone, not with --mode iso"},
     [](const OptionRow& row, const std::string& text, Request& r) { r.colorbar = read_flag(row, text); }},
    {{.key = "range",
      .argument = "LOW,HIGH",
      .unit = "the values'",
      .standard = "those there are",
      .help = "values at the ends of colours and opacity"},
     read_range},
    {{.key = "iso",
      .argument = "VALUE",
      .unit = "the values'",
      .standard = "35 % of the way from the background",
      .help = "of the surface; draws it where no --mode is given"},
     read_iso},
    {{.key = "camera",
      .argument = "AZIMUTH,ELEVATION[,ZOOM]",
      .unit = "degrees",
      .standard = "35,20,1",
      .help = "where it stands, in degrees"},
     read_camera},
    {{.key = "threads", .argument = "N", .standard = "0", .help = "number of threads; 0: one per core"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.backend.threads = static_cast<int>(read_count(row, text, 0, kMaxThreads));
     }},
    {{.key = "memory",
      .argument = "SIZE",
      .unit = "bytes",
      .standard = "what is available",
      .help = "of the CPU, for tables, macrocells and decoded blocks: a packed file that decodes to more is rendered "
              "from a cache, the same picture more slowly"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.backend.memory.ceiling = read_bytes(row, text);
     }},
    {{.key = "device-memory",
      .argument = "SIZE",
      .unit = "bytes",
      .standard = "what is free",
      .help =
          "of each CUDA device, for the volume: one that takes more is rendered from a cache, the same picture more "
          "slowly"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.backend.device_memory = read_bytes(row, text);
     }},
    {{.key = "lod",
      .argument = "auto|off|BIAS",
      .unit = "levels",
      .standard = "off",
      .help = "level of detail; auto: where a pixel is wider than a voxel, means of 2^3, 4^3 ... voxels as wide as the "
              "pixel take their place, smoother, though peaks are lost in means; BIAS: that many levels coarser"},
     read_lod},
    {{.key = "lod-scattered",
      .argument = "LEVELS",
      .unit = "levels",
      .standard = "0",
      .help =
          "with --lod, path: further levels coarser for light after its first scattering and on its way from a light: "
          "a cache is asked for less, shadows are a little off"},
     read_lod_scattered},
};

bool is_backend_option(std::string_view key) {
  constexpr std::array kKeys{"backend", "devices", "threads", "memory", "device-memory"};
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

}  // namespace

void add_picture_options(CLI::App& command, GivenOptions& given) {
  add_options<Request>(command, kPictureOptions, given);
}

void add_backend_options(CLI::App& command, GivenOptions& given) {
  for (const auto& option : kPictureOptions) {
    if (is_backend_option(option.row.key)) add_option(command, option.row, given);
  }
}

BackendChoice read_backend_choice(const GivenOptions& given) {
  PictureRequest request;
  read_options<Request>(kPictureOptions, given, request);
  return request.backend;
}

std::string filter_name(Filter filter) {
  if (filter == Filter::nearest) return "nearest";
  return filter == Filter::trilinear ? "trilinear" : "stochastic";
}

PictureRequest read_picture_request(const GivenOptions& options) {
  const GivenOptions given = without_empty(options);
  PictureRequest request;
  request.sampling.samples = 0;
  read_options<Request>(kPictureOptions, given, request);
  choose_iso_mode(given, request);
  check_colorbar(request);
  check_scattered_levels(request);
  if (request.sampling.samples == 0) request.sampling.samples = default_samples(request.scene.mode);
  request.options.environment = load_environment(request.scene);
  return request;
}

std::vector<std::string> picture_inputs(const GivenOptions& given, const PictureRequest& request) {
  std::vector<std::string> paths;
  if (const auto scene = given.find("scene"); scene != given.end()) paths.push_back(scene->second);
  if (const std::string& environment = request.scene.lighting.environment; !environment.empty()) {
    paths.push_back(environment);
  }
  return paths;
}

}  // namespace weir
