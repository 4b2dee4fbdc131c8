// The CPU back end: tiles of a picture on oneTBB, a few samples a pass. The
// picture depends on task and sample count alone, never on threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "gpu/dense_volume.h"
#include "gpu/image.h"
#include "gpu/render_task.h"
#include "gpu/volume_sampler.h"

namespace weir {

struct CpuRenderOptions {
  std::uint32_t samples = 1;                  ///< per pixel
  int threads = 0;                            ///< 0: all of the machine's
  const std::atomic<bool>* cancel = nullptr;  ///< looked at before every tile
  /// Called with the pixel samples done so far, from any thread, one at a time.
  std::function<void(std::uint64_t)> progress;
};

/// The mean of all samples. Throws Error(interrupted) where `cancel` was set. Of VolumeSampler and DenseSampler.
template <class Volume>
Image render_cpu(const RenderTask<Volume>& task, const CpuRenderOptions& options);

}  // namespace weir
