// The arguments of calls that survey and encode packed blocks on a device. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "format/base/host_device.h"
#include "format/packed/block_coder.h"
#include "gpu/cuda/encode/encoder_tables.h"

namespace weir {

struct DigestTables;

/// Most voxels along an axis that fit the device's integers.
inline constexpr std::int64_t kLongestAxis = std::numeric_limits<std::int32_t>::max() / 8;

/// The place of a row of blocks along x.
struct BlockRow {
  std::int64_t linear = 0;     ///< position of the row's first block in the volume, x fastest
  std::int32_t first[3] = {};  ///< first voxel of that block, relative to the volume's first voxel
  std::int32_t unused = 0;
};

/// Values on the device, x fastest, and blocks of them: a box of blocks, or rows of blocks along x.
struct BlockBox {
  const float* values = nullptr;
  std::int32_t extent[3] = {};     ///< voxels
  std::int32_t corner[3] = {};     ///< of a box's first block, relative to the first voxel
  std::uint32_t blocks[3] = {};    ///< along each axis; for rows: length of each row, number of rows, 1
  const BlockRow* rows = nullptr;  ///< on the device; null: the blocks are a box

  WEIR_HOST_DEVICE std::uint32_t count() const { return blocks[0] * blocks[1] * blocks[2]; }
  /// Returns the first voxel of a block along an axis.
  WEIR_HOST_DEVICE std::int32_t first(std::uint32_t block, unsigned axis) const {
    if (rows != nullptr) {
      const std::uint32_t along = axis == 0 ? 8 * (block % blocks[0]) : 0U;
      return rows[block / blocks[0]].first[axis] + static_cast<std::int32_t>(along);
    }
    const std::uint32_t layer = blocks[0] * blocks[1];
    const std::uint32_t at = axis == 0   ? block % layer % blocks[0]
                             : axis == 1 ? block % layer / blocks[0]
                                         : block / layer;
    return corner[axis] + static_cast<std::int32_t>(8 * at);
  }
  /// Returns whether all of a block's voxels have values.
  WEIR_HOST_DEVICE bool covers(std::uint32_t block) const {
    for (unsigned axis = 0; axis < 3; ++axis) {
      if (first(block, axis) < 0 || first(block, axis) > extent[axis] - 8) return false;
    }
    return true;
  }
};

/// Where a box's blocks lie in their volume.
struct BlockPlace {
  std::int64_t first[3] = {};   ///< position of the box's first block
  std::int64_t across[2] = {};  ///< blocks of the volume along x and y
  std::uint32_t odd[3] = {};    ///< per axis: 1 if the first block's position in all of index space is odd

  /// Returns the position in the volume, x fastest, of the box's block number `block`.
  WEIR_HOST_DEVICE std::int64_t linear(const BlockBox& box, std::uint32_t block) const {
    if (box.rows != nullptr) return box.rows[block / box.blocks[0]].linear + block % box.blocks[0];
    const std::uint32_t column = block % (box.blocks[0] * box.blocks[1]);
    const std::int64_t x = first[0] + column % box.blocks[0];
    const std::int64_t y = first[1] + column / box.blocks[0];
    const std::int64_t z = first[2] + block / (box.blocks[0] * box.blocks[1]);
    return x + across[0] * (y + across[1] * z);
  }
};

/// Arguments of a call that summarises blocks.
struct SummaryCall {
  BlockBox box;
  BlockPlace place;
  const DigestTables* tables = nullptr;
  BlockSummary* summaries = nullptr;  ///< one per block
};

/// Arguments of a call that copies the values of blocks.
struct ValuesCall {
  BlockBox box;
  const std::uint32_t* blocks = nullptr;
  std::uint32_t count = 0;  ///< number of `blocks`
  float* values = nullptr;  ///< 512 per block, in the order of a leaf
};

/// Arguments of a call that counts values in bins.
struct CountCall {
  const float* values = nullptr;
  std::uint64_t count = 0;
  double scale = 0;  ///< factor of a value
  double base = 0;   ///< number of the first bin
  std::uint32_t bins = 0;
  unsigned long long* counts = nullptr;
};

/// Most bins of a CountCall.
inline constexpr std::uint32_t kMostCountedBins = 1024;

/// Arguments of a survey.
struct SurveyCall {
  BlockBox box;
  const CostTables* tables = nullptr;
  RungAsk ask;
  BlockFigures* figures = nullptr;  ///< one per block
  RungCost* costs = nullptr;        ///< ask.most() per block
};

/// Arguments of a call that surveys the near rungs of blocks that were surveyed before.
struct NearCall {
  BlockBox box;
  const CostTables* tables = nullptr;
  const CodeTables* codes = nullptr;
  RungAsk ask;
  BlockFigures* figures = nullptr;  ///< one per block, as the survey has left them
  const RungCost* rungs = nullptr;  ///< costs of the rungs, as the survey has left them
  NearCost* costs = nullptr;        ///< ask.near.most() per block
};

/// What the first and the second step of encoding find for a block.
struct alignas(16) StreamState {
  std::uint32_t signs[16];  ///< of the non-zero values, by place
  std::uint32_t number;     ///< code of the mean
  std::uint32_t state[2];
  std::uint16_t nonzero;
  std::uint16_t words;  ///< number of words in front of the states
  std::uint8_t end;     ///< in units of kEndUnit places; 0: only a mean
  std::uint8_t number_bits;
  std::uint8_t left;  ///< 1: the block is left to the host
  // Only for streams that are not of a transform.
  std::uint8_t head;  ///< first byte
  float lattice[2];   ///< minimum and quantum
};

/// Arguments of a call that writes streams.
struct EncodeCall {
  BlockBox box;
  BlockConstants constants;  ///< without the tables
  const CostTables* tables = nullptr;
  const CodeTables* codes = nullptr;
  const StreamAsk* asks = nullptr;
  std::uint32_t count = 0;   ///< number of asks; the arrays below are by ask
  bool on_lattices = false;  ///< some asks are not of a transform
  StreamState* states = nullptr;
  std::uint32_t* coded = nullptr;  ///< 512 per ask, by place: see code_steps.h
  std::uint16_t* words = nullptr;  ///< those of ask i begin at words_at(i)
  float* decoded = nullptr;        ///< 512 per ask
  std::byte* out = nullptr;
  std::uint8_t* made = nullptr;

  WEIR_HOST_DEVICE std::size_t words_at(std::uint32_t i) const { return asks[i].offset / 2 + std::size_t{i}; }
};

/// Arguments of a call that makes records of written streams.
struct RecordCall {
  BlockBox box;
  BlockPlace place;
  const DigestTables* tables = nullptr;
  const StreamAsk* asks = nullptr;
  std::uint32_t count = 0;         ///< number of asks; the arrays below are by ask
  const float* decoded = nullptr;  ///< 512 per ask
  LeafRecord* records = nullptr;
  Digest* sources = nullptr;  ///< digests of the blocks' values
};

}  // namespace weir
