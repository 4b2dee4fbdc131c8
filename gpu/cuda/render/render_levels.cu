#include "gpu/cuda/bricks/brick_sampler.h"
#include "gpu/cuda/render/render_kernel.cuh"
#include "gpu/volume/levelled_volume.h"

namespace weir {

template <Filter kFilter>
using Levelled = LevelledVolume<BrickSampler<kFilter>, TextureSampler>;

template void launch_render(const RenderTask<Levelled<Filter::trilinear>>&, std::uint32_t, std::uint32_t, Float3*,
                            cudaStream_t);
template void launch_render(const RenderTask<Levelled<Filter::stochastic>>&, std::uint32_t, std::uint32_t, Float3*,
                            cudaStream_t);
template void launch_render(const RenderTask<Levelled<Filter::nearest>>&, std::uint32_t, std::uint32_t, Float3*,
                            cudaStream_t);

}  // namespace weir
