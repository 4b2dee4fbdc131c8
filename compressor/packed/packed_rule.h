// The parameters of a packed file that selection needs besides the ladders of its blocks.
#pragma once

#include <cstdint>
#include <optional>

#include "compressor/packed/ladder_window.h"
#include "format/packed/packed_layout.h"

namespace weir {

struct PackedRule {
  bool preview = true;        ///< the tree holds each block's mean, for other programs than weir
  std::int32_t coarsest = 0;  ///< step number that a step field of 0 stands for
  /// The window of keys. Rungs that no cut within the window can choose are left out, whether they are built or not.
  std::optional<KeyWindow> window{};
  /// A bound of the volume's squared error if no block has a stream; 0: no bound is known.
  double most_error = 0;
};

/// Step fields have 6 bits.
inline constexpr std::int32_t kPackedSteps = 64;

/// The most bytes of a chunk besides its streams and their ends in the directory: the cost of a region with streams.
inline constexpr std::uint64_t kChunkCost = packed::chunk::kGroups + packed::chunk::kAlignment - 1;

/// Returns the coarsest step that is useful to a block of a volume with finite values in [min, max].
std::int32_t coarsest_step(float min, float max);

}  // namespace weir
