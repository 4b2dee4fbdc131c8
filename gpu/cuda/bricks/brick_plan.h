// How much a brick cache holds.
#pragma once

#include <cstdint>

namespace weir {

struct BrickPlan {
  std::uint32_t pages = 0;          ///< of regions at a time
  std::uint32_t slots = 0;          ///< bricks at a time
  std::uint32_t across = 1;         ///< bricks along x of the texture, of which the first place is nobody's
  std::uint32_t down = 1;           ///< and along y
  std::uint32_t blocks = 0;         ///< that are decoded together, 8 at least
  std::uint32_t most_requests = 0;  ///< bricks that one turn may ask for
};

}  // namespace weir
