#include "format/sidecar/scene.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>

#include "format/base/toml_reader.h"
#include "format/sidecar/colormap_names.h"

namespace weir {

namespace {

constexpr std::array kModes{RenderMode::path, RenderMode::dvr, RenderMode::iso, RenderMode::mip};
constexpr Bounds kUnit{0, 1};
constexpr Bounds kRadiance{0, 1e6};
constexpr Bounds kFloats{-std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
constexpr Bounds kDirection{-1e15, 1e15};
constexpr Bounds kPlace{-1e60, 1e60};  // in the world, for voxels of any size; make_camera() counts in voxels

const toml::table& as_table(const TomlReader& reader, const toml::node& node, std::string_view key) {
  if (!node.is_table()) reader.fail(node, cat(key, " must be a table"));
  return *node.as_table();
}

void check_not_zero(const TomlReader& reader, const toml::node& node, std::string_view key, const Double3& v) {
  if (v == Double3{0, 0, 0}) reader.fail(node, cat(key, " is (0, 0, 0), it must have a direction"));
}

void read_camera(TomlReader reader, SceneCamera& camera) {
  reader.read("position", camera.position, kPlace);
  reader.read("look_at", camera.look_at, kPlace);
  if (reader.read("up", camera.up, kDirection)) check_not_zero(reader, *reader.find("up"), "up", camera.up);
  reader.read("azimuth", camera.azimuth, {-3600, 3600});
  reader.read("elevation", camera.elevation, {-90, 90});
  reader.read("zoom", camera.zoom, {0.01, 100});
  reader.read("fov", camera.fov, {0.1, 170});
  std::string framing;
  if (reader.read("frame", framing)) {
    if (framing != "content" && framing != "volume") {
      reader.fail(*reader.find("frame"), cat("frame is \"", framing, "\", it must be content or volume"));
    }
    camera.framing = framing == "content" ? Framing::content : Framing::volume;
  }
  reader.finish();
}

// Reads an array of arrays of N numbers. The first number is the position, in [0, 1], and positions rise.
template <std::size_t N, class Add>
void read_points(TomlReader& reader, std::string_view key, const Add& add) {
  const toml::node* node = reader.find(key);
  if (node == nullptr) return;
  if (!node->is_array() || node->as_array()->size() < 2) {
    reader.fail(*node, cat(key, " must be an array of at least two points, each an array of ", N, " numbers"));
  }
  double last = 0;
  for (const toml::node& item : *node->as_array()) {
    const std::array<double, N> point = reader.numbers<N>(item, key, kUnit);
    if (point[0] < last) reader.fail(item, cat(key, " has position ", point[0], " behind ", last, "; positions rise"));
    last = point[0];
    add(point);
  }
}

// Reads whole voxel indices, [[x0, x1], [y0, y1], [z0, z1]], half open.
void read_region(TomlReader& reader, SceneVolume& volume) {
  const toml::node* node = reader.find("region");
  if (node == nullptr) return;
  if (!node->is_array() || node->as_array()->size() != 3) {
    reader.fail(*node, "region must be [[x0, x1], [y0, y1], [z0, z1]], voxels, x0 inclusive, x1 exclusive");
  }
  std::array<std::int64_t, 3> lo{};
  std::array<std::int64_t, 3> hi{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const toml::node& item = *node->as_array()->get(axis);
    const auto [from, to] = reader.numbers<2>(item, "region", {-2147483648.0, 2147483648.0});
    if (from != std::floor(from) || to != std::floor(to) || !(from < to)) {
      reader.fail(item, cat("region has ", from, " to ", to, "; it must be whole voxels, the first below the second"));
    }
    lo[axis] = static_cast<std::int64_t>(from);
    hi[axis] = static_cast<std::int64_t>(to);
  }
  volume.region = Box{{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
}

void read_colormap(TomlReader& reader, std::string& colormap) {
  if (!reader.read("colormap", colormap) || colormap.empty()) return;
  std::string known;
  for (const std::string& name : split(kColormapNames, '|')) {
    if (name == colormap) return;
    known += cat(known.empty() ? "" : ", ", name);
  }
  reader.fail(*reader.find("colormap"), cat("colormap is \"", colormap, "\", it must be one of ", known));
}

void read_volume(TomlReader reader, SceneVolume& volume) {
  read_colormap(reader, volume.colormap);
  if (reader.read("range", volume.range, kFloats) && (*volume.range)[0] > (*volume.range)[1]) {
    reader.fail(*reader.find("range"), "range must not fall");
  }
  read_points<2>(reader, "opacity", [&](const std::array<double, 2>& p) { volume.opacity.push_back({p[0], p[1]}); });
  read_points<4>(reader, "color", [&](const std::array<double, 4>& p) {
    volume.color.push_back({p[0], {p[1], p[2], p[3]}});
  });
  reader.read("density", volume.density, {0, 1e30});
  reader.read("albedo", volume.albedo, kUnit);
  reader.read("anisotropy", volume.anisotropy, {-0.99, 0.99});
  reader.read("emission", volume.emission, kRadiance);
  reader.read("shading", volume.shading, kUnit);
  reader.read("iso", volume.iso, kFloats);
  reader.read("max_bounces", volume.max_bounces, {0, 1 << 20});
  read_region(reader, volume);
  reader.finish();
}

// An environment replaces all light except [[light]], so keys that it would make ineffective are refused.
void read_environment(TomlReader& reader, SceneLighting& lighting) {
  const bool given = reader.read("environment", lighting.environment);
  if (given && lighting.environment.empty()) {
    reader.fail(*reader.find("environment"), "environment is empty, it must be the path of an .exr or .hdr file");
  }
  for (const std::string_view key : {"environment_rotation", "environment_scale"}) {
    if (const toml::node* node = reader.find(key); node != nullptr && !given) {
      reader.fail(*node, cat(key, " without environment; name the picture as environment = \"FILE\""));
    }
  }
  for (const std::string_view key : {"ambient", "zenith", "horizon", "ground"}) {
    if (const toml::node* node = reader.find(key); node != nullptr && given) {
      reader.fail(*node, cat(key, " beside environment, which takes its place; leave one of them out"));
    }
  }
  reader.read("environment_rotation", lighting.environment_rotation, {-3600, 3600});
  reader.read("environment_scale", lighting.environment_scale, kRadiance);
}

void read_background(TomlReader& reader, SceneLighting& lighting) {
  const toml::node* node = reader.find("background");
  if (node == nullptr || !node->is_string()) {
    reader.read("background", lighting.background, kRadiance);
    return;
  }
  const std::string name = node->value_or(std::string{});
  if (name != "environment" || lighting.environment.empty()) {
    reader.fail(*node, cat("background is \"", name, "\", it must be a colour, or \"environment\" where one is given"));
  }
  lighting.environment_behind = true;
}

void read_lighting(TomlReader reader, SceneLighting& lighting) {
  std::optional<Double3> ambient;
  reader.read("ambient", ambient, kRadiance);
  lighting.zenith = lighting.horizon = lighting.ground = ambient;
  reader.read("zenith", lighting.zenith, kRadiance);
  reader.read("horizon", lighting.horizon, kRadiance);
  reader.read("ground", lighting.ground, kRadiance);
  read_environment(reader, lighting);
  read_background(reader, lighting);
  reader.read("exposure", lighting.exposure, {0, 1e6});
  reader.finish();
}

SceneLight read_light(TomlReader reader, const toml::node& node) {
  SceneLight light{};
  if (!reader.read("direction", light.direction, kDirection)) reader.fail(node, "a light needs a direction");
  check_not_zero(reader, *reader.find("direction"), "direction", light.direction);
  reader.read("irradiance", light.irradiance, kRadiance);
  reader.finish();
  return light;
}

}  // namespace

std::string_view render_mode_name(RenderMode mode) {
  switch (mode) {
    case RenderMode::path:
      return "path";
    case RenderMode::dvr:
      return "dvr";
    case RenderMode::iso:
      return "iso";
    case RenderMode::mip:
      return "mip";
  }
  return "unknown";
}

std::optional<RenderMode> parse_render_mode(std::string_view name) {
  const auto* found =
      std::find_if(kModes.begin(), kModes.end(), [&](RenderMode m) { return render_mode_name(m) == name; });
  return found == kModes.end() ? std::nullopt : std::optional(*found);
}

Scene parse_scene(std::string_view text, const std::string& path) {
  const toml::table document = parse_toml(text, path);
  TomlReader reader(document, "the scene", path);
  Scene scene;
  std::string mode;
  if (reader.read("mode", mode)) {
    const std::optional<RenderMode> known = parse_render_mode(mode);
    if (!known) reader.fail(*reader.find("mode"), cat("mode is \"", mode, "\", it must be path, dvr, iso or mip"));
    scene.mode = *known;
  }
  const auto section = [&](std::string_view key, auto read, auto& into) {
    if (const toml::node* node = reader.find(key)) {
      read(TomlReader(as_table(reader, *node, key), cat('[', key, ']'), path), into);
    }
  };
  section("camera", read_camera, scene.camera);
  section("volume", read_volume, scene.volume);
  section("lighting", read_lighting, scene.lighting);
  if (!scene.lighting.environment.empty()) {
    scene.lighting.environment = (std::filesystem::path(path).parent_path() / scene.lighting.environment).string();
  }
  if (const toml::node* node = reader.find("light")) {
    if (!node->is_array_of_tables()) reader.fail(*node, "light must be an array of tables, [[light]]");
    if (node->as_array()->size() > kMaxSceneLights) {
      reader.fail(*node, cat("there are ", node->as_array()->size(), " lights, at most ", kMaxSceneLights));
    }
    scene.lighting.lights.emplace();
    for (const toml::node& light : *node->as_array()) {
      scene.lighting.lights->push_back(read_light(TomlReader(*light.as_table(), "[[light]]", path), light));
    }
  }
  reader.finish();
  return scene;
}

Scene load_scene(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text(kMostSceneBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file.is_open() || file.bad()) {
    const int reason = errno;
    if (reason == EACCES || reason == EPERM || reason == EIO) throw io_error(path, "read", reason);
    throw Error(ErrorKind::input, cat(path, ": cannot read the scene; it must be an existing TOML file"),
                reason != 0 ? std::optional(SystemFailure{reason, path}) : std::nullopt);
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kMostSceneBytes) {
    throw Error(ErrorKind::input, cat(path, ": more than ", kMostSceneBytes, " bytes, no scene has; give a TOML file"));
  }
  return parse_scene(text, path);
}

}  // namespace weir
