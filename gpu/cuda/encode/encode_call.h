// What calls that survey and encode packed blocks on a device work on. For host and device.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/base/host_device.h"
#include "format/packed/block_coder.h"
#include "gpu/cuda/encode/encoder_tables.h"

namespace weir {

/// Values on the device, x fastest, and the blocks that they are the values of.
struct BlockBox {
  const float* values = nullptr;
  std::int32_t extent[3] = {};  ///< voxels
  std::int32_t corner[3] = {};  ///< of the first block, from the first voxel: 0 or less
  std::uint32_t blocks[3] = {};

  WEIR_HOST_DEVICE std::uint32_t count() const { return blocks[0] * blocks[1] * blocks[2]; }
};

/// What a survey works on.
struct SurveyCall {
  BlockBox box;
  const CostTables* tables = nullptr;
  RungAsk ask;
  BlockFigures* figures = nullptr;  ///< of each block
  RungCost* costs = nullptr;        ///< `most` of each block
  std::uint32_t most = 0;
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
  std::uint8_t unused;
};

/// What writes streams.
struct EncodeCall {
  BlockBox box;
  BlockConstants constants;  ///< but for the tables
  const CostTables* tables = nullptr;
  const CodeTables* codes = nullptr;
  const StreamAsk* asks = nullptr;
  std::uint32_t count = 0;  ///< of asks; the rest is by ask
  StreamState* states = nullptr;
  std::uint32_t* coded = nullptr;  ///< 512 of each, by place: see code_steps.h
  std::uint16_t* words = nullptr;  ///< those of an ask begin at words_at()
  float* decoded = nullptr;        ///< 512 of each
  std::byte* out = nullptr;
  std::uint8_t* made = nullptr;

  WEIR_HOST_DEVICE std::size_t words_at(std::uint32_t i) const { return asks[i].offset / 2 + std::size_t{i}; }
};

}  // namespace weir
