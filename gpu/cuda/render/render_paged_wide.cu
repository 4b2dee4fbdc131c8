#include "gpu/cuda/render/render_paged.cuh"

namespace weir {

WEIR_LAUNCH_PAGED_OF(WidePositions);

}  // namespace weir
