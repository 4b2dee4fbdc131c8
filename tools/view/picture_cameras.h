// Computes the cameras of pictures without rendering, to find what a viewer points at.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>

#include "format/nanovdb/nvdb_file.h"
#include "format/sidecar/scene.h"
#include "gpu/render/render_setup.h"
#include "gpu/scene/camera.h"
#include "gpu/volume/macrocell_grid.h"

namespace weir {

class PictureCameras {
 public:
  /// `cell`: least edge in voxels of the macrocells that pictures are made with, because macrocells bound the framed
  /// content.
  explicit PictureCameras(std::int64_t cell) : cell_(cell) {}

  /// Returns the camera that RenderSetup gives the picture. Macrocells are used only if the scene frames its content,
  /// and are kept for the next call. If a file has none they are computed, which decodes the whole file. Any thread
  /// may ask. Throws as RenderSetup; if the scene's region shows nothing, the camera frames the whole volume.
  Camera camera(const std::shared_ptr<const NvdbFile>& file, const Scene& scene, const RenderOptions& options);
  /// Returns the macrocells of the file, which are kept too. Any thread may ask.
  std::shared_ptr<const MacrocellGrid> cells_of(const std::shared_ptr<const NvdbFile>& file);

 private:
  struct Entry {
    std::weak_ptr<const NvdbFile> file;
    std::shared_ptr<const MacrocellGrid> cells;
  };
  static constexpr std::size_t kMost = 2;  // a file, and the file it is compared with

  const std::int64_t cell_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // most recently used first
};

}  // namespace weir
