#include "gpu/cuda/encode/device_coder.h"

#include <cstdint>
#include <utility>

#include "gpu/cuda/encode/coder_state.h"
#include "gpu/cuda/encode/device_blocks.h"

namespace weir {
namespace {

// Most boxes that are loaded at once. More boxes would not keep the device busier, and each takes page-locked memory.
constexpr std::size_t kMostBoxes = 4;
// Most host bytes per box: figures and costs of 4,096 blocks, and two batches of their streams and decoded values. A
// box of more blocks takes less than all kMostBoxes boxes together, and there is only one at a time.
constexpr std::uint64_t kBoxHostBytes = std::uint64_t{32} << 20U;

class DeviceCoder final : public BlockCoder {
 public:
  DeviceCoder(int device, std::function<void(const Error&)> failed)
      : state_(std::make_shared<CoderState>(device, kMostBoxes, std::move(failed))) {}

  std::unique_ptr<LoadedBlocks> load(std::span<const float> values, const Box& voxels, const Box& blocks) override {
    const std::optional<BlockBox> box = block_box(voxels, blocks);
    if (!box) return nullptr;
    return state_->attempt([&]() -> std::unique_ptr<LoadedBlocks> {
      std::unique_ptr<BoxMemory> memory = state_->boxes.take();
      if (!memory) return nullptr;
      return std::make_unique<DeviceBlocks>(state_, std::move(memory), values, *box);
    });
  }
  std::uint64_t host_bytes() const override { return kMostBoxes * kBoxHostBytes; }

 private:
  std::shared_ptr<CoderState> state_;
};

}  // namespace

std::unique_ptr<BlockCoder> make_device_coder(int device, std::function<void(const Error&)> failed) {
  check_device(device);
  const KeptDevice kept(device);
  return std::make_unique<DeviceCoder>(device, std::move(failed));
}

}  // namespace weir
