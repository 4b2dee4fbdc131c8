// One picture as a kernel sees it: plain data with host or device pointers, and the function that both back ends call
// for every sample of every pixel.
#pragma once

#include "format/sidecar/scene.h"
#include "gpu/scene/camera.h"
#include "gpu/trace/iso_surface.h"
#include "gpu/trace/max_projection.h"
#include "gpu/trace/path_tracer.h"
#include "gpu/trace/ray_march.h"

namespace weir {

/// All of a picture except its medium.
struct RenderFrame {
  Lighting lighting;
  Camera camera;
  RenderMode mode = RenderMode::path;
  std::int32_t width = 1;   ///< pixels
  std::int32_t height = 1;  ///< pixels
  std::uint64_t seed = 0;
  float step = 0.5F;  ///< dvr, iso, mip: distance between samples, in shortest voxel edges
  float shading = 0;  ///< dvr
  float iso = 0;      ///< iso: value of the surface
  Float3 iso_color{1, 1, 1};
  std::int32_t max_bounces = 0;  ///< path
};

template <class Volume>
struct RenderTask : RenderFrame {
  Medium<Volume> medium;
};

/// Returns the radiance of sample `sample` of pixel (x, y), with y pointing down, as finite linear RGB. Depends only
/// on the arguments. `mode` is the task's mode, passed separately for callers that know it at compile time.
template <class Volume>
WEIR_HOST_DEVICE Float3 render_sample(const RenderTask<Volume>& task, RenderMode mode, std::int32_t x, std::int32_t y,
                                      std::uint32_t sample) {
  const std::uint64_t pixel =
      static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(task.width) + static_cast<std::uint64_t>(x);
  Random random(task.seed, pixel, sample);
  const float u = (static_cast<float>(x) + random.uniform()) / static_cast<float>(task.width);
  const float v = (static_cast<float>(y) + random.uniform()) / static_cast<float>(task.height);
  const Float3 direction = task.camera.direction(u, v);
  const Float3& eye = task.camera.position;
  Float3 radiance;
  switch (mode) {
    case RenderMode::path:
      radiance = trace_path(task.medium, task.lighting, eye, direction, task.max_bounces, random);
      break;
    case RenderMode::dvr:
      radiance = march(task.medium, task.lighting, eye, direction, task.step, task.shading, random);
      break;
    case RenderMode::iso:
      radiance = shade_iso(task.medium, task.lighting, eye, direction, task.iso, task.iso_color, task.step);
      break;
    case RenderMode::mip:
      radiance = project_max(task.medium, task.lighting, eye, direction, task.step, random);
      break;
  }
  // A light of 1e38 multiplied by a colour may overflow. Such a sample counts as black, so that it does not spoil its
  // pixel.
  return is_finite(radiance.x + radiance.y + radiance.z) ? radiance : Float3{};
}

template <class Volume>
WEIR_HOST_DEVICE Float3 render_sample(const RenderTask<Volume>& task, std::int32_t x, std::int32_t y,
                                      std::uint32_t sample) {
  return render_sample(task, task.mode, x, y, sample);
}

}  // namespace weir
