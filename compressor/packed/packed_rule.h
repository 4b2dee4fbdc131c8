// What selection must know of a packed file besides the ladders of its blocks.
#pragma once

#include <cstdint>
#include <optional>

#include "compressor/packed/ladder_window.h"
#include "format/packed/packed_layout.h"

namespace weir {

struct PackedRule {
  bool preview = true;        ///< the tree holds each block's mean, for other programs than weir
  std::int32_t coarsest = 0;  ///< step number that a step field of 0 stands for
  /// Rungs that no cut within it can choose are left out, whether they are built or not.
  std::optional<KeyWindow> window{};
  /// A bound of the squared error of the volume where no block has a stream; 0: none is known.
  double most_error = 0;
};

/// Step fields have 6 bits.
inline constexpr std::int32_t kPackedSteps = 64;

/// Most bytes of a chunk besides its streams and their ends in the directory: what a region with streams costs.
inline constexpr std::uint64_t kChunkCost = packed::chunk::kGroups + packed::chunk::kAlignment - 1;

/// The coarsest step that a block of a volume whose finite values lie in [min, max] can have a use for.
std::int32_t coarsest_step(float min, float max);

}  // namespace weir
