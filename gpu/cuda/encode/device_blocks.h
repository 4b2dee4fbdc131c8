// The blocks of a box on a device: surveys them and encodes their streams (format/packed/block_coder.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "format/base/index.h"
#include "format/packed/block_coder.h"
#include "gpu/cuda/encode/coder_state.h"
#include "gpu/cuda/encode/encode_call.h"

namespace weir {

/// Returns the position of the box `blocks` within the box `voxels`, or nullopt if the numbers do not fit the
/// device's integers.
std::optional<BlockBox> block_box(const Box& voxels, const Box& blocks);

/// Returns the positions of rows of blocks, all equally long, within the box `voxels`, which has `lattice` as its
/// blocks; empty if the numbers do not fit the device's integers.
std::vector<BlockRow> block_rows(const Box& voxels, const NodeLattice& lattice, std::span<const Box> rows);

class DeviceBlocks final : public ResidentBlocks {
 public:
  /// `memory` comes from coder->boxes. Copies `values` from the host to the device. Throws Error(io).
  DeviceBlocks(std::shared_ptr<CoderState> coder, std::unique_ptr<BoxMemory> memory, std::span<const float> values,
               const BlockBox& box);
  /// For a box whose values are on the device already, at `place` of their volume.
  DeviceBlocks(std::shared_ptr<CoderState> coder, std::unique_ptr<BoxMemory> memory, const BlockBox& box,
               const BlockPlace& place);
  /// For rows of blocks whose values are on the device already. `box` has no rows yet. Throws Error(io).
  DeviceBlocks(std::shared_ptr<CoderState> coder, std::unique_ptr<BoxMemory> memory, const BlockBox& box,
               std::span<const BlockRow> rows);

  void begin_survey(const RungAsk& ask) override;
  std::optional<SurveyedBlocks> end_survey() override;
  std::unique_ptr<PendingStreams> encode(std::span<const StreamAsk> asks, const BlockConstants& constants) override;
  std::optional<std::span<const float>> values(std::span<const std::uint32_t> blocks) override;

 private:
  std::shared_ptr<CoderState> coder_;
  Lent<BoxMemory> memory_;
  BlockBox box_;
  std::optional<BlockPlace> place_;  // of the blocks, if their volume is resident
  std::optional<SurveyedBlocks> begun_;
};

}  // namespace weir
