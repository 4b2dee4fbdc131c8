// The CPU back end: tiles of a picture on oneTBB, a few samples a pass. The
// picture depends on task and sample count alone, never on threads.
#pragma once

#include "gpu/image/image.h"
#include "gpu/render/render_task.h"
#include "gpu/render/sample_options.h"
#include "gpu/volume/dense_volume.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

struct CpuRenderOptions : SampleOptions {
  int threads = 0;  ///< 0: all of the machine's
};

/// The mean of all samples. Throws Error(interrupted) where `cancel` was set. Of VolumeSampler and DenseSampler.
template <class Volume>
Image render_cpu(const RenderTask<Volume>& task, const CpuRenderOptions& options);

}  // namespace weir
