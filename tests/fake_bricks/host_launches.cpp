// The renderer's launches over what instead/ has in place of kernels.
// NOLINTBEGIN(bugprone-suspicious-include)
#include "gpu/cuda/render/render_bricks.cu"
#include "gpu/cuda/render/render_float_stochastic.cu"
#include "gpu/cuda/render/render_float_trilinear.cu"
#include "gpu/cuda/render/render_levels.cu"
#include "gpu/cuda/render/render_nearest.cu"
#include "gpu/cuda/render/render_paged.cu"
#include "gpu/cuda/render/render_paged_wide.cu"
#include "gpu/cuda/render/render_quantised_stochastic.cu"
#include "gpu/cuda/render/render_quantised_trilinear.cu"
#include "gpu/cuda/render/render_texture.cu"
// NOLINTEND(bugprone-suspicious-include)
