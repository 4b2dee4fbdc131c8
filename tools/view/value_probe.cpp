#include "tools/view/value_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "gpu/math/narrow.h"
#include "gpu/math/ray.h"
#include "gpu/render/render_setup.h"
#include "gpu/scene/scene_camera.h"

namespace weir {
namespace {

constexpr float kStep = 0.5F;              // in units of the shortest voxel edge
constexpr float kMostProbeSteps = 20'000;  // steps along a ray
constexpr float kSeen = 1.0F / 512;        // share of a pixel's light below which nothing is seen

// Reads voxels one after the other; most lie in the same block as the previous voxel.
class NearbyVoxels {
 public:
  explicit NearbyVoxels(const NvdbGrid& grid) : grid_(grid) {}

  float value(const Index3& i) {
    const Index3 block = floor_div(i, kLeafDim);
    if (!known_ || !(block == block_)) {
      const GridBlock found = grid_.block_at(i);
      grid_.decode_block(found, values_);
      block_ = block;
      known_ = true;
    }
    const Index3 at = i - block * kLeafDim;
    return values_[static_cast<std::size_t>(at.x << 6 | at.y << 3 | at.z)];
  }

 private:
  const NvdbGrid& grid_;
  bool known_ = false;
  Index3 block_;
  std::array<float, 512> values_{};
};

Box shown_box(const NvdbGrid& grid, const Scene& scene) {
  return scene.volume.region ? intersect(*scene.volume.region, grid.index_bbox()) : grid.index_bbox();
}

}  // namespace

std::optional<ProbedVoxel> probe_voxel(const NvdbGrid& grid, const Scene& scene, const Camera& camera,
                                       const MinMax& range, float background, double x, double y) {
  const GridFrame frame = frame_of(grid);
  const Box box = shown_box(grid, scene);
  if (box.empty()) return std::nullopt;
  const Float3 stretch = narrow(frame.stretch());
  const Float3 direction = camera.direction(static_cast<float>(x), static_cast<float>(y));
  Ray ray{camera.position, direction / stretch};
  const float length = enter(ray, {narrow(Double3{static_cast<double>(box.lo.x - frame.domain.lo.x),
                                                  static_cast<double>(box.lo.y - frame.domain.lo.y),
                                                  static_cast<double>(box.lo.z - frame.domain.lo.z)}),
                                   narrow(Double3{static_cast<double>(box.hi.x - frame.domain.lo.x),
                                                  static_cast<double>(box.hi.y - frame.domain.lo.y),
                                                  static_cast<double>(box.hi.z - frame.domain.lo.z)})});
  if (!(length > 0)) return std::nullopt;

  const TransferFunction transfer = picture_transfer({frame, range, background}, scene, {});
  const float density = picture_density(scene, frame);
  const float iso = picture_iso(scene.volume, transfer, background);
  const float step = std::max(kStep, length / kMostProbeSteps);

  NearbyVoxels voxels(grid);
  std::optional<ProbedVoxel> best;
  float most = 0;
  float through = 1;
  std::optional<bool> inside;
  for (float t = 0.5F * step; t < length; t += step) {
    const Float3 p = ray.at(t);
    const Index3 at = min(max(frame.domain.lo + Index3{static_cast<std::int64_t>(std::floor(p.x)),
                                                       static_cast<std::int64_t>(std::floor(p.y)),
                                                       static_cast<std::int64_t>(std::floor(p.z))},
                              box.lo),
                          box.hi - Index3{1, 1, 1});
    const float value = voxels.value(at);
    if (!std::isfinite(value)) continue;
    const auto take = [&] { best = ProbedVoxel{at, {}, value}; };
    if (scene.mode == RenderMode::mip) {
      if (!best || value > best->value) take();
    } else if (scene.mode == RenderMode::iso) {
      const bool above = value >= iso;
      if (inside && *inside != above) {
        take();
        break;
      }
      inside = above;
    } else {
      const float absorbed = 1.0F - std::exp(-transfer.at(value).a * density * step);
      if (through * absorbed > most) {
        most = through * absorbed;
        if (most > kSeen) take();
      }
      through *= 1.0F - absorbed;
      if (through < kSeen) break;
    }
  }
  if (best) best->world = frame.world(best->voxel);
  return best;
}

std::optional<float> value_at(const NvdbGrid& grid, const Double3& world) {
  const GridFrame frame = frame_of(grid);
  const Double3 index = frame.index(world);
  const Box& box = frame.domain;
  const std::array<std::int64_t, 3> low{box.lo.x, box.lo.y, box.lo.z};
  const std::array<std::int64_t, 3> high{box.hi.x, box.hi.y, box.hi.z};
  std::array<std::int64_t, 3> voxel{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = std::floor(index[a]);
    // Checked before the conversion to an integer, because places may lie anywhere.
    if (!(at >= static_cast<double>(low[a]) && at < static_cast<double>(high[a]))) return std::nullopt;
    voxel[a] = static_cast<std::int64_t>(at);
  }
  return grid.value({voxel[0], voxel[1], voxel[2]});
}

}  // namespace weir
