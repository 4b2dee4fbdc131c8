// How much a brick cache holds.
#pragma once

#include <cstdint>

namespace weir {

struct BrickPlan {
  std::uint32_t pages = 0;          ///< pages of regions that are held at a time
  std::uint32_t slots = 0;          ///< bricks that are held at a time
  std::uint32_t across = 1;         ///< bricks along x of the texture; its first place stays unused
  std::uint32_t down = 1;           ///< bricks along y
  std::uint32_t blocks = 0;         ///< blocks that are decoded together, at least 8
  std::uint32_t most_requests = 0;  ///< bricks that one turn may request
};

}  // namespace weir
