// The CPU renderer: draws tiles of a picture on oneTBB, a few samples per pass. The picture depends only on the task
// and the sample count, never on the number of threads.
#pragma once

#include <cstddef>
#include <span>

#include "gpu/image/image.h"
#include "gpu/render/render_task.h"
#include "gpu/render/sample_options.h"
#include "gpu/volume/cached_blocks.h"
#include "gpu/volume/dense_volume.h"
#include "gpu/volume/levelled_volume.h"
#include "gpu/volume/volume_sampler.h"

namespace weir {

struct CpuRenderOptions : SampleOptions {
  int threads = 0;  ///< 0 means all of the machine's
};

/// Returns the largest number of threads that render if `threads` are asked for (0: all of the machine's).
std::size_t render_threads(int threads);

/// Returns the mean of all samples. Throws Error(interrupted) if `cancel` is set; `kept` then holds what was drawn.
/// Passes on what a look-up in the volume throws. Instantiated for VolumeSampler, DenseSampler and CachedSampler,
/// each with or without levels of detail in memory.
template <class Volume>
Image render_cpu(const RenderTask<Volume>& task, const CpuRenderOptions& options);
/// Does the same for volumes that only one thread at a time may use. All `tasks` are of the same picture; there is
/// one for each of render_threads(options.threads).
template <class Volume>
Image render_cpu(std::span<const RenderTask<Volume>> tasks, const CpuRenderOptions& options);

}  // namespace weir
