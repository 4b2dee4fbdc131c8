// What calls that survey and encode packed blocks on a device work on. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "format/base/host_device.h"
#include "format/packed/block_coder.h"
#include "gpu/cuda/encode/encoder_tables.h"

namespace weir {

struct DigestTables;

/// Voxels along an axis that the device's whole numbers take.
inline constexpr std::int64_t kLongestAxis = std::numeric_limits<std::int32_t>::max() / 8;

/// Values on the device, x fastest, and the blocks that they are the values of.
struct BlockBox {
  const float* values = nullptr;
  std::int32_t extent[3] = {};  ///< voxels
  std::int32_t corner[3] = {};  ///< of the first block, from the first voxel: 0 or less
  std::uint32_t blocks[3] = {};

  WEIR_HOST_DEVICE std::uint32_t count() const { return blocks[0] * blocks[1] * blocks[2]; }
  /// The first voxel of a block along an axis.
  WEIR_HOST_DEVICE std::int32_t first(std::uint32_t block, unsigned axis) const {
    const std::uint32_t layer = blocks[0] * blocks[1];
    const std::uint32_t at = axis == 0   ? block % layer % blocks[0]
                             : axis == 1 ? block % layer / blocks[0]
                                         : block / layer;
    return corner[axis] + static_cast<std::int32_t>(8 * at);
  }
  /// Whether there are values for all of a block's voxels.
  WEIR_HOST_DEVICE bool covers(std::uint32_t block) const {
    for (unsigned axis = 0; axis < 3; ++axis) {
      if (first(block, axis) < 0 || first(block, axis) > extent[axis] - 8) return false;
    }
    return true;
  }
};

/// Where the blocks of a box lie among those of their volume.
struct BlockPlace {
  std::int64_t first[3] = {};   ///< position of the first one
  std::int64_t across[2] = {};  ///< blocks of the volume along x and y
  std::uint32_t odd[3] = {};    ///< whether the first one's place among all of index space is, along each axis

  /// By position in the box, of the volume, x fastest.
  WEIR_HOST_DEVICE std::int64_t linear(const BlockBox& box, std::uint32_t block) const {
    const std::uint32_t column = block % (box.blocks[0] * box.blocks[1]);
    const std::int64_t x = first[0] + column % box.blocks[0];
    const std::int64_t y = first[1] + column / box.blocks[0];
    const std::int64_t z = first[2] + block / (box.blocks[0] * box.blocks[1]);
    return x + across[0] * (y + across[1] * z);
  }
};

/// What summarises blocks.
struct SummaryCall {
  BlockBox box;
  BlockPlace place;
  const DigestTables* tables = nullptr;
  BlockSummary* summaries = nullptr;  ///< of each block
};

/// What copies the values of blocks.
struct ValuesCall {
  BlockBox box;
  const std::uint32_t* blocks = nullptr;
  std::uint32_t count = 0;  ///< of these
  float* values = nullptr;  ///< 512 of each, in the order of a leaf
};

/// What counts values in bins.
struct CountCall {
  const float* values = nullptr;
  std::uint64_t count = 0;
  double scale = 0;  ///< of a value
  double base = 0;   ///< of the first bin
  std::uint32_t bins = 0;
  unsigned long long* counts = nullptr;
};

/// Most bins of a CountCall.
inline constexpr std::uint32_t kMostCountedBins = 1024;

/// What a survey works on.
struct SurveyCall {
  BlockBox box;
  const CostTables* tables = nullptr;
  RungAsk ask;
  BlockFigures* figures = nullptr;  ///< of each block
  RungCost* costs = nullptr;        ///< ask.most() of each block
};

/// What looks at near rungs of blocks that were surveyed.
struct NearCall {
  BlockBox box;
  const CostTables* tables = nullptr;
  const CodeTables* codes = nullptr;
  RungAsk ask;
  BlockFigures* figures = nullptr;  ///< of each block, as the survey has left them
  const RungCost* rungs = nullptr;  ///< costs of their rungs, as the survey has left them
  NearCost* costs = nullptr;        ///< ask.near.most() of each block
};

/// What the first step of encoding finds of a block, and the second.
struct alignas(16) StreamState {
  std::uint32_t signs[16];  ///< of what is not zero, by place
  std::uint32_t number;     ///< code of the mean
  std::uint32_t state[2];
  std::uint16_t nonzero;
  std::uint16_t words;  ///< that lie in front of the states
  std::uint8_t end;     ///< in units of kEndUnit places; 0: a mean alone
  std::uint8_t number_bits;
  std::uint8_t left;  ///< to the host
  // Of streams that are not of a transform.
  std::uint8_t head;  ///< first byte
  float lattice[2];   ///< minimum and quantum
};

/// What writes streams.
struct EncodeCall {
  BlockBox box;
  BlockConstants constants;  ///< but for the tables
  const CostTables* tables = nullptr;
  const CodeTables* codes = nullptr;
  const StreamAsk* asks = nullptr;
  std::uint32_t count = 0;   ///< of asks; the rest is by ask
  bool on_lattices = false;  ///< some asks are not of a transform
  StreamState* states = nullptr;
  std::uint32_t* coded = nullptr;  ///< 512 of each, by place: see code_steps.h
  std::uint16_t* words = nullptr;  ///< those of an ask begin at words_at()
  float* decoded = nullptr;        ///< 512 of each
  std::byte* out = nullptr;
  std::uint8_t* made = nullptr;

  WEIR_HOST_DEVICE std::size_t words_at(std::uint32_t i) const { return asks[i].offset / 2 + std::size_t{i}; }
};

/// What makes records of streams that were written.
struct RecordCall {
  BlockBox box;
  BlockPlace place;
  const DigestTables* tables = nullptr;
  const StreamAsk* asks = nullptr;
  std::uint32_t count = 0;         ///< of asks; the rest is by ask
  const float* decoded = nullptr;  ///< 512 of each
  LeafRecord* records = nullptr;
  Digest* sources = nullptr;  ///< of the blocks' values
};

}  // namespace weir
