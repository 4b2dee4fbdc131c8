#include "gpu/cuda/bricks/brick_sampler.h"
#include "gpu/cuda/render/render_kernel.cuh"

template void weir::launch_render(const RenderTask<BrickSampler<Filter::trilinear>>&, std::uint32_t, std::uint32_t,
                                  Float3*, cudaStream_t);
template void weir::launch_render(const RenderTask<BrickSampler<Filter::stochastic>>&, std::uint32_t, std::uint32_t,
                                  Float3*, cudaStream_t);
template void weir::launch_render(const RenderTask<BrickSampler<Filter::nearest>>&, std::uint32_t, std::uint32_t,
                                  Float3*, cudaStream_t);
