// A volume of the CUDA back end: what each device holds of it.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "gpu/cuda/render/brick_volume.h"
#include "gpu/cuda/render/device_volume.h"
#include "gpu/cuda/volume/dense_texture.h"
#include "gpu/render/backend.h"

namespace weir {

/// A file's grid, or a dense volume, on every device of the back end, in the order of the devices.
class CudaVolume : public LoadedVolume {
 public:
  CudaVolume(std::shared_ptr<const NvdbFile> file, std::vector<std::unique_ptr<DeviceVolume>> grids,
             MacrocellGrid cells, LoadSummary summary)
      : file_(std::move(file)),
        grids_(std::move(grids)),
        cells_(std::move(cells)),
        info_(volume_info(file_->grid(), cells_)),
        summary_(std::move(summary)) {}
  CudaVolume(std::shared_ptr<const NvdbFile> file, std::vector<std::unique_ptr<BrickVolume>> bricks,
             MacrocellGrid cells, LoadSummary summary)
      : file_(std::move(file)),
        bricks_(std::move(bricks)),
        cells_(std::move(cells)),
        info_(volume_info(file_->grid(), cells_)),
        summary_(std::move(summary)) {}
  CudaVolume(const VolumeInfo& info, std::vector<std::unique_ptr<DenseTexture>> textures, MacrocellGrid cells,
             LoadSummary summary)
      : textures_(std::move(textures)), cells_(std::move(cells)), info_(info), summary_(std::move(summary)) {}

  const VolumeInfo& info() const override { return info_; }
  const LoadSummary& load_summary() const override { return summary_; }
  const MacrocellGrid& cells() const { return cells_; }
  bool dense() const { return !textures_.empty(); }
  bool in_bricks() const { return !bricks_.empty(); }
  BrickVolume& bricks(std::size_t i) const { return *bricks_[i]; }
  DeviceVolume& grid(std::size_t i) { return *grids_[i]; }
  DenseTexture& texture(std::size_t i) { return *textures_[i]; }

 private:
  std::shared_ptr<const NvdbFile> file_;  ///< kept because a zero-copy grid lies in its mapping
  std::vector<std::unique_ptr<DeviceVolume>> grids_;
  std::vector<std::unique_ptr<BrickVolume>> bricks_;
  std::vector<std::unique_ptr<DenseTexture>> textures_;
  MacrocellGrid cells_;
  VolumeInfo info_;
  LoadSummary summary_;
};

}  // namespace weir
