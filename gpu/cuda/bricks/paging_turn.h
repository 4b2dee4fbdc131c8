// The result of one turn of a brick cache.
#pragma once

#include <cstdint>

namespace weir {

struct PagingTurn {
  std::uint32_t asked_pages = 0;
  std::uint32_t asked_bricks = 0;
  std::uint32_t pages = 0;    ///< brought in
  std::uint32_t bricks = 0;   ///< brought in
  std::uint32_t evicted = 0;  ///< bricks that were evicted
  bool unfit = false;         ///< 16 bits do not hold some brick: all bricks must be made again with floats

  /// Returns whether the cache is too small for what was used since the last turn together with what was missing.
  bool crowded() const { return pages < asked_pages || bricks < asked_bricks; }
};

}  // namespace weir
