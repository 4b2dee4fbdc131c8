#include "gpu/cuda/render/render_kernel.cuh"

template void weir::launch_render(const RenderTask<TextureSampler>&, std::uint32_t, std::uint32_t, Float3*,
                                  cudaStream_t);
