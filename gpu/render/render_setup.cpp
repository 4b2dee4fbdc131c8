#include "gpu/render/render_setup.h"

#include <algorithm>
#include <cfloat>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/image/colormap.h"
#include "gpu/math/box_points.h"
#include "gpu/math/narrow.h"
#include "gpu/scene/scene_transfer.h"
#include "gpu/volume/level_lattice.h"

namespace weir {

namespace {

// What a mode looks best with if the scene sets nothing.
struct ModeDefaults {
  std::string_view colormap;
  double density;  // optical depth of the longest edge at opacity 1
  Double3 background;
  double exposure;
};

constexpr Double3 kDarkGray{0.035, 0.035, 0.035};

ModeDefaults defaults_of(RenderMode mode) {
  switch (mode) {
    case RenderMode::path:
      return {"white", 250, kDarkGray, 1.4};
    case RenderMode::dvr:
      return {"viridis", 200, kDarkGray, 1.8};
    case RenderMode::iso:
      return {"white", 1, kDarkGray, 0.8};
    case RenderMode::mip:
      break;
  }
  return {"gray", 1, {0, 0, 0}, 1};
}

// Returns the grid's stored range if it is finite. Other writers' NaN policies may leave none; then the cells' range
// is returned.
MinMax value_range(const NvdbGrid& grid, const MacrocellGrid& cells) {
  const MinMax stored{grid.value_min(), grid.value_max()};
  return has_finite_ends(stored) ? stored : cells.finite_range().value_or(MinMax{0, 1});
}

// Calculates in double, because the directions of a scene may have any length.
Float3 unit_vector(const Double3& v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0)) return {0, 0, 1};
  return normalised(narrow(Double3{v[0] / largest, v[1] / largest, v[2] / largest}), {0, 0, 1});
}

// Returns the longest edge of the domain, in shortest voxel edges.
double longest_edge(const GridFrame& frame) {
  const Double3 size = frame.size();
  return *std::max_element(size.begin(), size.end());
}

// Returns the edge in world units.
double shortest_voxel_edge(const GridFrame& frame) {
  return *std::min_element(frame.voxel_size.begin(), frame.voxel_size.end());
}

Lighting make_lighting(const Scene& scene, const ModeDefaults& defaults, const Environment* environment) {
  Lighting light;
  if (environment != nullptr) light.environment = environment->view();
  const SceneLighting& s = scene.lighting;
  light.up = unit_vector(scene.camera.up);
  light.zenith = narrow(s.zenith.value_or(Double3{0.6, 0.68, 0.8}));
  light.horizon = narrow(s.horizon.value_or(Double3{0.6, 0.6, 0.6}));
  light.ground = narrow(s.ground.value_or(Double3{0.22, 0.2, 0.18}));
  // The default background looks the same on the screen at any exposure.
  const double exposure = std::max(s.exposure.value_or(defaults.exposure), 1e-6);
  const Double3& ground = defaults.background;
  light.background =
      narrow(s.background.value_or(Double3{ground[0] / exposure, ground[1] / exposure, ground[2] / exposure}));
  light.sky_behind = s.environment_behind;
  std::vector<SceneLight> key{{{0.6, -0.5, 0.9}, {2.2, 2.1, 1.9}}};
  if (environment != nullptr) key.clear();  // an environment has its own sun
  for (const SceneLight& l : s.lights.value_or(key)) {
    if (light.light_count == kMaxLights) break;
    light.lights[light.light_count++] = {unit_vector(l.direction), narrow(l.irradiance)};
  }
  return light;
}

}  // namespace

static_assert(kMaxSceneLights == kMaxLights);

VolumeInfo volume_info(const NvdbGrid& grid, const MacrocellGrid& cells) {
  return {frame_of(grid), value_range(grid, cells), grid.background()};
}

bool levels_are_of_use(int first, float coarsest) { return first > 0 && coarsest > static_cast<float>(first - 1); }

std::string levels_note(int first, int wanted, float coarsest) {
  if (first > 0 && first <= wanted) return "";
  const std::string asked = cat("levels of detail from ", wanted, " on were asked for, ");
  if (first == 0) return asked + "but there is no memory for them; voxels were read";
  const std::string there = cat(asked, "those from ", first, " on fit into the memory kept for them");
  return levels_are_of_use(first, coarsest) ? there : there + ", of which none was of use; voxels were read";
}

TransferFunction picture_transfer(const VolumeInfo& volume, const Scene& scene, const RenderOptions& options) {
  return make_transfer_function(scene.volume, volume.range, options.background.value_or(volume.background),
                                defaults_of(scene.mode).colormap);
}

// The value lies between the background and the value farthest from it. A surface in the background's noise shows
// nothing.
float picture_iso(const SceneVolume& volume, const TransferFunction& transfer, float background) {
  if (volume.iso) return static_cast<float>(*volume.iso);
  const double low = transfer.low();
  const double high = transfer.high();
  const double from = is_finite(background) ? std::clamp<double>(background, low, high) : low;
  const double farthest = high - from >= from - low ? high : low;
  return static_cast<float>(from + 0.35 * (farthest - from));
}

float picture_density(const Scene& scene, const GridFrame& frame) { return picture_density(scene, frame, frame); }

float picture_density(const Scene& scene, const GridFrame& frame, const GridFrame& along) {
  // The edge of `along` in shortest voxel edges of `frame`. If both are the same frame, the ratio is exactly 1.
  const double longest = longest_edge(along) * (shortest_voxel_edge(along) / shortest_voxel_edge(frame));
  const double density = scene.volume.density.value_or(defaults_of(scene.mode).density) / longest;
  return static_cast<float>(std::min(density, static_cast<double>(FLT_MAX)));  // infinity times no opacity is NaN
}

RenderSetup::RenderSetup(const VolumeInfo& volume, const MacrocellGrid& cells, const Scene& scene,
                         const RenderOptions& options)
    : domain_(volume.frame.domain),
      cells_(cells),
      transfer_(picture_transfer(volume, scene, options)),
      environment_(options.environment ? options.environment : load_environment(scene)) {
  const ModeDefaults defaults = defaults_of(scene.mode);

  // Returns the position relative to the domain's lowest corner.
  const auto local = [&](const Index3& i) {
    const Index3 offset = i - domain_.lo;
    return Float3{static_cast<float>(offset.x), static_cast<float>(offset.y), static_cast<float>(offset.z)};
  };
  medium_.transfer = transfer_.view();
  medium_.cells = cells_.lattice();
  const Box seen = shown(scene);
  medium_.shown = {local(seen.lo), local(seen.hi)};
  medium_.cell_values = cells_.bounds().data();
  medium_.stretch = narrow(volume.frame.stretch());
  medium_.density = picture_density(scene, volume.frame, options.density_frame.value_or(volume.frame));
  medium_.albedo = static_cast<float>(scene.volume.albedo);
  medium_.emission = static_cast<float>(scene.volume.emission);
  medium_.g = static_cast<float>(scene.volume.anisotropy);

  frame_.iso = picture_iso(scene.volume, transfer_, options.background.value_or(volume.background));
  frame_.iso_color = rgb(transfer_.at(frame_.iso));
  frame_.lighting = make_lighting(scene, defaults, environment_.get());
  frame_.camera =
      make_camera(scene.camera, volume.frame, framed(scene), static_cast<double>(options.width) / options.height);
  frame_.mode = scene.mode;
  frame_.width = options.width;
  frame_.height = options.height;
  frame_.seed = options.seed;
  // Sample positions are counted in floats, so there are at most 2^22 along the longest way through the volume.
  frame_.step = static_cast<float>(std::max(0.5, 2 * longest_edge(volume.frame) / (1 << 22)));
  frame_.shading = static_cast<float>(scene.volume.shading);
  frame_.max_bounces = scene.volume.max_bounces;
  if (options.levels) levels_ = levels_for(*options.levels);
  tone_ = {.exposure = static_cast<float>(scene.lighting.exposure.value_or(defaults.exposure)),
           .soft_clip = scene.mode == RenderMode::path};
}

void RenderSetup::bound_cells(std::vector<MinMax> bounds) {
  levelled_cells_.emplace(cells_.nodes(), std::move(bounds));
  medium_.cell_values = levelled_cells_->bounds().data();
  majorants_.clear();
}

const std::vector<float>& RenderSetup::majorants() const {
  if (majorants_.empty()) majorants_ = cells().majorants(transfer_);
  return majorants_;
}

// The nearest and the farthest point that is shown bound the levels.
std::optional<LevelsUsed> RenderSetup::levels_for(const LevelOfDetail& detail) const {
  const Camera& camera = frame_.camera;
  const float pixel = std::min(2 * length(camera.right) / static_cast<float>(frame_.width),
                               2 * length(camera.down) / static_cast<float>(frame_.height));
  LevelsUsed used;
  // A cube has the same number of voxels along each axis. Along the axis with the longest voxels it must not be wider
  // than the pixel.
  used.choice = {camera.position, medium_.stretch, std::log2(pixel / max_component(medium_.stretch)) + detail.bias, 0};
  // Only light on a path scatters.
  used.choice.scattered = used.choice.camera + (frame_.mode == RenderMode::path ? detail.scattered : 0);
  used.coarsest = used.choice.level(farthest_point(medium_.shown, camera.position), RayKind::scattered);
  if (!(used.coarsest > 0)) return std::nullopt;
  const float finest = used.choice.level(nearest_point(medium_.shown, camera.position), RayKind::camera);
  used.finest = static_cast<int>(clamped(finest, 1.0F, static_cast<float>(kMostLevels - 1)));
  return used;
}

// Returns the scene's region, or the whole domain.
Box RenderSetup::shown(const Scene& scene) const {
  if (!scene.volume.region) return domain_;
  const Box box = intersect(*scene.volume.region, domain_);
  if (!box.empty()) return box;
  const Box& d = domain_;
  throw Error(ErrorKind::usage, cat("the scene's region shows no voxel of the volume, whose index box is [[", d.lo.x,
                                    ", ", d.hi.x, "], [", d.lo.y, ", ", d.hi.y, "], [", d.lo.z, ", ", d.hi.z, "]]"));
}

// Returns the boxes that the camera frames. An opacity below a hundredth is only haze and is ignored.
std::vector<Box> RenderSetup::framed(const Scene& scene) const {
  const Box all = shown(scene);
  if (scene.camera.framing == Framing::volume) return {all};
  std::vector<Box> boxes = cells_.content([&](std::size_t i) {
    const MinMax& bounds = cells_.bounds()[i];
    return scene.mode == RenderMode::iso ? bounds.min <= frame_.iso && frame_.iso <= bounds.max
                                         : majorants()[i] > 0.01F;
  });
  for (Box& box : boxes) box = intersect(box, all);
  std::erase_if(boxes, [](const Box& box) { return box.empty(); });
  return boxes.empty() ? std::vector<Box>{all} : boxes;
}

}  // namespace weir
