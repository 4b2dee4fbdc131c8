#include "gpu/scene/scene_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/math/narrow.h"

namespace weir {

namespace {

constexpr double kMargin = 0.94;    // fraction of the picture that the box may fill
constexpr double kFarthest = 1e15;  // voxels; tracers count in floats, and their squares must stay finite

Double3 operator+(const Double3& a, const Double3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Double3 operator-(const Double3& a, const Double3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Double3 operator*(const Double3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot(const Double3& a, const Double3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Double3 cross(const Double3& a, const Double3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Double3& a) { return std::hypot(a[0], a[1], a[2]); }
Double3 unit(const Double3& a) {
  const double largest = std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
  const Double3 scaled{a[0] / largest, a[1] / largest, a[2] / largest};  // 1 / length of a subnormal is infinite
  return scaled * (1 / length(scaled));
}
Double3 as_double(const Index3& i) {
  return {static_cast<double>(i.x), static_cast<double>(i.y), static_cast<double>(i.z)};
}

// Returns a unit vector across `up`: the axis after the one nearest to `up`, without its part along `up`. So azimuth 0
// is +x if up is +z.
Double3 across(const Double3& up) {
  const auto most =
      std::max_element(up.begin(), up.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  Double3 axis{0, 0, 0};
  axis[static_cast<std::size_t>(most - up.begin() + 1) % 3] = 1;
  return unit(axis - up * dot(axis, up));
}

// Returns the distance from `target` at which all boxes fit the picture.
double framing_distance(const GridFrame& frame, std::span<const Box> boxes, const Double3& target,
                        const Double3& forward, const Double3& right, const Double3& down, double tan_x, double tan_y) {
  double distance = 0;
  for (const Box& box : boxes) {
    for (int corner = 0; corner < 8; ++corner) {
      const Index3 at{(corner & 1) != 0 ? box.hi.x : box.lo.x, (corner & 2) != 0 ? box.hi.y : box.lo.y,
                      (corner & 4) != 0 ? box.hi.z : box.lo.z};
      const Double3 c = frame.physical(as_double(at)) - target;
      const double reach = std::max(std::abs(dot(c, right)) / tan_x, std::abs(dot(c, down)) / tan_y);
      distance = std::max(distance, reach / kMargin - dot(c, forward));
    }
  }
  return distance;
}

Double3 centre(const GridFrame& frame, std::span<const Box> boxes) {
  Box all = boxes.front();
  for (const Box& box : boxes) all = {min(all.lo, box.lo), max(all.hi, box.hi)};
  return (frame.physical(as_double(all.lo)) + frame.physical(as_double(all.hi))) * 0.5;
}

}  // namespace

Double3 GridFrame::stretch() const {
  const double shortest = *std::min_element(voxel_size.begin(), voxel_size.end());
  return voxel_size * (1 / shortest);
}

Double3 GridFrame::physical(const Double3& index) const {
  const Double3 local = index - as_double(domain.lo);
  const Double3 s = stretch();
  return {local[0] * s[0], local[1] * s[1], local[2] * s[2]};
}

Double3 GridFrame::world(const Index3& index) const {
  const Double3 i = as_double(index);
  return {origin[0] + voxel_size[0] * i[0], origin[1] + voxel_size[1] * i[1], origin[2] + voxel_size[2] * i[2]};
}

Double3 GridFrame::index(const Double3& world) const {
  const Double3 offset = world - origin;
  return {offset[0] / voxel_size[0] + 0.5, offset[1] / voxel_size[1] + 0.5, offset[2] / voxel_size[2] + 0.5};
}

Double3 GridFrame::size() const { return physical(as_double(domain.hi)); }

GridFrame frame_of(const NvdbGrid& grid) { return {grid.index_bbox(), grid.voxel_size(), grid.world_origin()}; }

AzimuthFrame azimuth_frame(const Double3& up, double degrees) {
  const Double3 axis = unit(up);
  const Double3 e1 = across(axis);
  const Double3 e2 = cross(axis, e1);
  const double angle = degrees * std::numbers::pi / 180;
  return {narrow(axis), narrow(e1 * std::cos(angle) + e2 * std::sin(angle)),
          narrow(e2 * std::cos(angle) - e1 * std::sin(angle))};
}

Camera make_camera(const SceneCamera& scene, const GridFrame& frame, std::span<const Box> content, double aspect) {
  const auto from_world = [&](const Double3& world, std::string_view key) {
    const Double3 index = frame.index(world);
    for (const double along : index) {
      if (std::abs(along) <= kFarthest) continue;
      throw Error(ErrorKind::usage, cat("the camera's ", key, ", (", world[0], ", ", world[1], ", ", world[2],
                                        "), is farther than ", kFarthest, " voxels from the volume; move it closer"));
    }
    return frame.physical(index);
  };
  const double tan_y = std::tan(scene.fov * std::numbers::pi / 360);
  const double tan_x = tan_y * aspect;
  const Double3 up = unit(scene.up);
  const Double3 target = scene.look_at ? from_world(*scene.look_at, "look_at") : centre(frame, content);

  Double3 position;
  Double3 forward;
  Double3 right;
  if (scene.position) {
    position = from_world(*scene.position, "position");
    const Double3 view = target - position;
    if (!(length(view) > 0)) {
      throw Error(ErrorKind::usage, cat("the camera stands at the point it looks at, (", (*scene.position)[0], ", ",
                                        (*scene.position)[1], ", ", (*scene.position)[2], "); move one of them"));
    }
    forward = unit(view);
    const Double3 side = cross(forward, up);
    right = length(side) > 1e-9 ? unit(side) : across(up);
  } else {
    const Double3 e1 = across(up);
    const Double3 e2 = cross(up, e1);
    const double azimuth = scene.azimuth * std::numbers::pi / 180;
    const double elevation = scene.elevation * std::numbers::pi / 180;
    const Double3 horizontal = e1 * std::cos(azimuth) + e2 * std::sin(azimuth);
    forward = (horizontal * std::cos(elevation) + up * std::sin(elevation)) * -1.0;
    right = e2 * std::cos(azimuth) - e1 * std::sin(azimuth);
    const double distance =
        framing_distance(frame, content, target, forward, right, cross(forward, right), tan_x, tan_y);
    position = target - forward * distance;
  }
  const Double3 down = cross(forward, right);
  for (std::size_t a = 0; a < 3; ++a) position[a] /= frame.stretch()[a];
  return {narrow(position), narrow(forward), narrow(right * (tan_x / scene.zoom)), narrow(down * (tan_y / scene.zoom))};
}

}  // namespace weir
