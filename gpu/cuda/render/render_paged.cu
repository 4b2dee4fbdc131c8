#include "gpu/cuda/render/render_paged.cuh"

namespace weir {

std::uint32_t paged_tiles(std::int32_t width, std::int32_t height) {
  const auto across = (static_cast<std::uint32_t>(width) + kTileWidth - 1) / kTileWidth;
  const auto down = (static_cast<std::uint32_t>(height) + kTileHeight - 1) / kTileHeight;
  std::uint32_t edge = 1;
  while (edge < across || edge < down) edge *= 2;
  return edge * edge;
}

WEIR_LAUNCH_PAGED_OF(FixedPositions);

}  // namespace weir
