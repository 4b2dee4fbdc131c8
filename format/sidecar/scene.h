// The look of a picture of a volume: camera, transfer function, medium, light. Plain data with defaults that suit any
// volume; nothing here depends on a grid. Parsed from TOML, see docs/scene.md for every key.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "format/base/index.h"

namespace weir {

using Double3 = std::array<double, 3>;

enum class RenderMode { path, dvr, iso, mip };

/// Convert a mode to and from "path", "dvr", "iso" or "mip".
std::string_view render_mode_name(RenderMode mode);
std::optional<RenderMode> parse_render_mode(std::string_view name);

/// What an orbiting camera frames. content: the part of the volume that the transfer function or the iso value shows.
/// volume: all of it, which is the same for every step of a series and every rate.
enum class Framing { content, volume };

/// With `position`, the camera stands there (world space) and looks at `look_at`. Without it, the camera orbits the
/// centre of what it frames.
struct SceneCamera {
  std::optional<Double3> position;
  std::optional<Double3> look_at;  ///< world space; default: the centre of what the camera frames
  Double3 up{0, 0, 1};
  double azimuth = 35;    ///< degrees around `up`
  double elevation = 20;  ///< degrees above the horizon, in [-90, 90]
  double zoom = 1;        ///< 1 fills the picture; 2 shows all twice as large
  Framing framing = Framing::content;
  double fov = 30;  ///< vertical, degrees, in (0, 180)
};

/// Opacity at a position of the value range, both in [0, 1].
struct OpacityPoint {
  double position;
  double opacity;
};

/// sRGB in [0, 1] at a position of the value range.
struct ColorPoint {
  double position;
  Double3 srgb;
};

struct SceneVolume {
  std::string colormap;                        ///< empty: the mode's default
  std::optional<std::array<double, 2>> range;  ///< values of positions 0 and 1; default: the grid's
  std::vector<OpacityPoint> opacity;           ///< by position; empty: rises with the distance from the background
  std::vector<ColorPoint> color;               ///< by position; replaces the colormap
  std::optional<double> density;               ///< optical depth of the longest edge at opacity 1
  double albedo = 0.98;                        ///< share of light scattered, times the colour
  double anisotropy = 0;                       ///< Henyey-Greenstein mean cosine, in (-1, 1)
  double emission = 0;                         ///< source radiance, times the colour
  double shading = 0.7;                        ///< dvr: 0 flat to 1 lit like a surface
  std::optional<double> iso;                   ///< value of the surface; default: from the range
  int max_bounces = 256;                       ///< path: scatterings at most
  std::optional<Box> region;                   ///< voxels of index space that are shown; default: all
};

/// Directional light.
struct SceneLight {
  Double3 direction;            ///< towards the light, in world space, any length but 0
  Double3 irradiance{1, 1, 1};  ///< linear RGB
};

/// Linear RGB radiance of the sky, by elevation or from a picture, and the background that the camera sees.
struct SceneLighting {
  std::optional<Double3> zenith;
  std::optional<Double3> horizon;
  std::optional<Double3> ground;
  std::string environment;                        ///< latitude-longitude picture that replaces the three above; empty:
                                                  ///< none
  double environment_rotation = 0;                ///< degrees about the camera's `up`
  double environment_scale = 1;                   ///< factor on the environment's radiance
  bool environment_behind = false;                ///< the camera sees the environment instead of `background`
  std::optional<Double3> background;              ///< default: the mode's
  std::optional<double> exposure;                 ///< factor on the radiance; default: the mode's
  std::optional<std::vector<SceneLight>> lights;  ///< at most 4; default: one key light, none with an environment
};

struct Scene {
  RenderMode mode = RenderMode::path;
  SceneCamera camera;
  SceneVolume volume;
  SceneLighting lighting;
};

/// The most directional lights that a scene may have.
inline constexpr std::size_t kMaxSceneLights = 4;

/// Parses a scene; paths in it are relative to the directory of `path`. Throws Error(input) "PATH:LINE:COLUMN: ..." for
/// broken TOML, an unknown key, a wrong type or a value out of range.
Scene parse_scene(std::string_view text, const std::string& path);
/// The most bytes of a scene; a transfer function of a thousand points takes some 30 KB.
inline constexpr std::size_t kMostSceneBytes = std::size_t{1} << 20U;

/// Parses the scene in a file. Throws Error(input) if the file is missing, unreadable or longer than kMostSceneBytes.
Scene load_scene(const std::string& path);

}  // namespace weir
