#include "gpu/cuda/render/render_kernel.cuh"

template void weir::launch_render(const RenderTask<TableSampler<QuantisedBlock, Filter::trilinear>>&, std::uint32_t,
                                  std::uint32_t, Float3*, cudaStream_t);
