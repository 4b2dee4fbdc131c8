// The CPU back end: tiles of a picture on oneTBB, a few samples a pass. The
// picture depends on task and sample count alone, never on threads.
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
  int threads = 0;  ///< 0: all of the machine's
};

/// Most threads that render, of those asked for.
std::size_t render_threads(int threads);

/// The mean of all samples. Throws Error(interrupted) where `cancel` was set, after which `kept` has what was drawn,
/// and what a look-up in the volume throws. Of VolumeSampler, DenseSampler and CachedSampler, with or without levels of
/// detail in memory.
template <class Volume>
Image render_cpu(const RenderTask<Volume>& task, const CpuRenderOptions& options);
/// The same of volumes that only one thread at a time may use: `tasks` are of the same picture, one for each of
/// render_threads(options.threads).
template <class Volume>
Image render_cpu(std::span<const RenderTask<Volume>> tasks, const CpuRenderOptions& options);

}  // namespace weir
