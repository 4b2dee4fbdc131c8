#include "tools/view/picture_cameras.h"

#include <algorithm>
#include <array>

#include "gpu/scene/scene_camera.h"

namespace weir {
namespace {

struct NoVolume {};  // a stand-in volume: a camera depends on no voxel

// Returns whether the position or direction of the camera depends on the shown content.
bool frames_content(const SceneCamera& camera) {
  return camera.framing == Framing::content && !(camera.position && camera.look_at);
}

}  // namespace

Camera PictureCameras::camera(const std::shared_ptr<const NvdbFile>& file, const Scene& scene,
                              const RenderOptions& options) {
  const NvdbGrid& grid = file->grid();
  const Box domain = grid.index_bbox();
  const Box region = scene.volume.region ? intersect(*scene.volume.region, domain) : domain;
  if (frames_content(scene.camera) && !region.empty()) {
    const std::shared_ptr<const MacrocellGrid> cells = cells_of(file);
    return RenderSetup(volume_info(grid, *cells), *cells, scene, options).bare_task(NoVolume{}).camera;
  }
  return make_camera(scene.camera, frame_of(grid), std::array{region.empty() ? domain : region},
                     static_cast<double>(options.width) / options.height);
}

std::shared_ptr<const MacrocellGrid> PictureCameras::cells_of(const std::shared_ptr<const NvdbFile>& file) {
  const auto find = [&] {
    return std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.file.lock() == file; });
  };
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = find(); found != entries_.end()) {
      entries_.splice(entries_.begin(), entries_, found);
      return found->cells;
    }
  }
  auto cells = std::make_shared<const MacrocellGrid>(file->grid(), cell_);
  const std::lock_guard lock(mutex_);
  if (find() == entries_.end()) entries_.push_front({file, cells});
  if (entries_.size() > kMost) entries_.pop_back();
  return cells;
}

}  // namespace weir
