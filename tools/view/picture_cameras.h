// The cameras of pictures, without the pictures: for who points at one.
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
  /// `cell`: voxels along the edge of the macrocells that pictures are made with, at least: they bound what is framed.
  explicit PictureCameras(std::int64_t cell) : cell_(cell) {}

  /// The one that RenderSetup gives the picture. Macrocells are taken only where the scene frames its content, and kept
  /// for the next time; those of a file that has none are gathered, which decodes all of it. Any thread may ask. Throws
  /// as RenderSetup; where the scene's region shows nothing, the camera is of the whole volume.
  Camera camera(const std::shared_ptr<const NvdbFile>& file, const Scene& scene, const RenderOptions& options);
  /// The macrocells of the file, kept likewise. Any thread may ask.
  std::shared_ptr<const MacrocellGrid> cells_of(const std::shared_ptr<const NvdbFile>& file);

 private:
  struct Entry {
    std::weak_ptr<const NvdbFile> file;
    std::shared_ptr<const MacrocellGrid> cells;
  };
  static constexpr std::size_t kMost = 2;  // a file, and the one it is compared with

  const std::int64_t cell_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // used last first
};

}  // namespace weir
