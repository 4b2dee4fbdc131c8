#include "gpu/cuda/encode/device_coder.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "format/packed/block_encode.h"
#include "gpu/cuda/encode/launch.h"
#include "gpu/cuda/encode/reused_memory.h"
#include "gpu/cuda/push/background_stream.h"

namespace weir {
namespace {

// Boxes that are loaded at once. More would not keep the device busier, and each takes page-locked memory.
constexpr std::size_t kMostBoxes = 4;
// Of each, at most: figures and costs of 4,096 blocks, and two batches of their streams and decoded values. A box of
// more blocks, of which there is one at a time, takes less than all of these.
constexpr std::uint64_t kBoxHostBytes = std::uint64_t{32} << 20U;

// What a box that is loaded takes, and a call that encodes.
struct BoxMemory {
  BackgroundStream stream;
  GrowingArray<float> values;
  GrowingArray<BlockFigures> figures;
  GrowingArray<RungCost> costs;
  GrowingPinned pinned;
};

struct StreamMemory {
  BackgroundStream stream;
  GrowingArray<StreamAsk> asks;
  GrowingArray<StreamState> states;
  GrowingArray<std::uint32_t> coded;
  GrowingArray<std::uint16_t> words;
  GrowingArray<float> decoded;
  GrowingArray<std::byte> out;
  GrowingArray<std::uint8_t> made;
  GrowingPinned pinned;
};

// What all boxes share.
struct CoderState {
  CoderState(int number, std::function<void(const Error&)> say)
      : device(number), failed(std::move(say)), costs(1), codes(1) {
    std::vector<CostTables> host_costs(1);
    std::vector<CodeTables> host_codes(1);
    make_encoder_tables(built_in_tables(), host_costs[0], host_codes[0]);
    costs.upload(host_costs);
    codes.upload(host_codes);
  }

  void fail(const Error& error) {
    if (!broken.exchange(true) && failed) failed(error);
  }
  // What `call` returns, or nothing where it or an earlier one has failed.
  template <class Call>
  auto attempt(const Call& call) -> decltype(call()) {
    if (broken) return {};
    try {
      check_cuda(cudaSetDevice(device), "choosing the device");
      return call();
    } catch (const Error& error) {
      fail(error);
      return {};
    }
  }

  int device;
  std::function<void(const Error&)> failed;
  std::atomic<bool> broken{false};
  DeviceArray<CostTables> costs;
  DeviceArray<CodeTables> codes;
  MemoryPool<BoxMemory> boxes{kMostBoxes};
  MemoryPool<StreamMemory> streams;
};

// Memory that goes back to its pool, once its stream has no more work.
template <class Memory>
class Lent {
 public:
  Lent(MemoryPool<Memory>& pool, std::unique_ptr<Memory> memory) : pool_(pool), memory_(std::move(memory)) {}
  ~Lent() {
    if (cudaStreamSynchronize(memory_->stream.get()) != cudaSuccess) cudaGetLastError();
    pool_.give_back(std::move(memory_));
  }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;

  Memory& operator*() const { return *memory_; }
  Memory* operator->() const { return memory_.get(); }

 private:
  MemoryPool<Memory>& pool_;
  std::unique_ptr<Memory> memory_;
};

template <class T>
void copy_back(std::span<T> to, const T* from, cudaStream_t stream, const char* what) {
  check_cuda(cudaMemcpyAsync(to.data(), from, to.size_bytes(), cudaMemcpyDeviceToHost, stream), what);
}

class DeviceStreams final : public PendingStreams {
 public:
  DeviceStreams(std::shared_ptr<CoderState> coder, const BlockBox& box, std::span<const StreamAsk> asks,
                const BlockConstants& constants)
      : coder_(std::move(coder)), memory_(coder_->streams, coder_->streams.take()) {
    const std::size_t count = asks.size();
    const std::size_t bytes = std::size_t{asks.back().offset} + asks.back().bytes;
    EncodeCall call;
    call.box = box;
    call.constants = constants;
    call.constants.tables = nullptr;
    call.tables = coder_->costs.data();
    call.codes = coder_->codes.data();
    StreamAsk* const asked = memory_->asks.at_least(count);
    call.asks = asked;
    call.count = static_cast<std::uint32_t>(count);
    call.states = memory_->states.at_least(count);
    call.coded = memory_->coded.at_least(512 * count);
    call.words = memory_->words.at_least(bytes / 2 + count + 1);
    call.decoded = memory_->decoded.at_least(512 * count);
    call.out = memory_->out.at_least(bytes);
    call.made = memory_->made.at_least(count);
    std::byte* const pinned = memory_->pinned.at_least(512 * sizeof(float) * count + count + bytes);
    const std::span<float> decoded(reinterpret_cast<float*>(pinned), 512 * count);
    const std::span<std::uint8_t> made(reinterpret_cast<std::uint8_t*>(pinned + decoded.size_bytes()), count);
    const std::span<std::byte> streams(pinned + decoded.size_bytes() + count, bytes);
    const cudaStream_t stream = memory_->stream.get();
    check_cuda(cudaMemcpyAsync(asked, asks.data(), asks.size_bytes(), cudaMemcpyHostToDevice, stream),
               "copying to the device");
    launch_encode(call, stream);
    const char* const what = "encoding on the device";
    copy_back(decoded, call.decoded, stream, what);
    copy_back(made, call.made, stream, what);
    copy_back(streams, call.out, stream, what);
    found_ = {streams, decoded, made};
  }

  std::optional<MadeStreams> wait() override {
    return coder_->attempt([&]() -> std::optional<MadeStreams> {
      check_cuda(cudaStreamSynchronize(memory_->stream.get()), "encoding on the device");
      return found_;
    });
  }

 private:
  std::shared_ptr<CoderState> coder_;
  Lent<StreamMemory> memory_;
  MadeStreams found_;
};

class DeviceBlocks final : public LoadedBlocks {
 public:
  /// `memory` is one of coder->boxes.
  DeviceBlocks(std::shared_ptr<CoderState> coder, std::unique_ptr<BoxMemory> memory, std::span<const float> values,
               const BlockBox& box)
      : coder_(std::move(coder)), memory_(coder_->boxes, std::move(memory)), box_(box) {
    float* const to = memory_->values.at_least(values.size());
    box_.values = to;
    const cudaStream_t stream = memory_->stream.get();
    check_cuda(cudaMemcpyAsync(to, values.data(), values.size_bytes(), cudaMemcpyHostToDevice, stream),
               "copying to the device");
    // Other streams read them, and the caller may change them.
    check_cuda(cudaStreamSynchronize(stream), "copying to the device");
  }

  void begin_survey(const RungAsk& ask) override {
    begun_ = coder_->attempt([&]() -> std::optional<SurveyedBlocks> {
      const std::size_t count = box_.count();
      SurveyCall call;
      call.box = box_;
      call.tables = coder_->costs.data();
      call.ask = ask;
      call.most = ask.most();
      call.figures = memory_->figures.at_least(count);
      call.costs = memory_->costs.at_least(call.most * count);
      std::byte* const pinned = memory_->pinned.at_least((sizeof(BlockFigures) + call.most * sizeof(RungCost)) * count);
      const std::span<BlockFigures> figures(reinterpret_cast<BlockFigures*>(pinned), count);
      const std::span<RungCost> costs(reinterpret_cast<RungCost*>(pinned + figures.size_bytes()), call.most * count);
      const cudaStream_t stream = memory_->stream.get();
      launch_survey(call, stream);
      copy_back(figures, call.figures, stream, "surveying on the device");
      copy_back(costs, call.costs, stream, "surveying on the device");
      return SurveyedBlocks{figures, costs};
    });
  }

  std::optional<SurveyedBlocks> end_survey() override {
    if (!begun_) return std::nullopt;
    return coder_->attempt([&]() -> std::optional<SurveyedBlocks> {
      check_cuda(cudaStreamSynchronize(memory_->stream.get()), "surveying on the device");
      return begun_;
    });
  }

  std::unique_ptr<PendingStreams> encode(std::span<const StreamAsk> asks, const BlockConstants& constants) override {
    return coder_->attempt([&]() -> std::unique_ptr<PendingStreams> {
      return std::make_unique<DeviceStreams>(coder_, box_, asks, constants);
    });
  }

 private:
  std::shared_ptr<CoderState> coder_;
  Lent<BoxMemory> memory_;
  BlockBox box_;
  std::optional<SurveyedBlocks> begun_;
};

// Of a box of voxels in one of blocks; nullopt where the device's whole numbers are too short.
std::optional<BlockBox> block_box(const Box& voxels, const Box& blocks) {
  BlockBox box;
  const Index3 extent = voxels.extent();
  const Index3 corner = blocks.lo - voxels.lo;
  const Index3 count = blocks.extent();
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max() / 8;
  if (voxels.voxels() > kMost || count.x > kMost || count.y > kMost || count.z > kMost) return std::nullopt;
  const std::int64_t all[3][3] = {
      {extent.x, corner.x, count.x}, {extent.y, corner.y, count.y}, {extent.z, corner.z, count.z}};
  for (int axis = 0; axis < 3; ++axis) {
    box.extent[axis] = static_cast<std::int32_t>(all[axis][0]);
    box.corner[axis] = static_cast<std::int32_t>(all[axis][1]);
    box.blocks[axis] = static_cast<std::uint32_t>(all[axis][2] / kLeafDim);
  }
  return box;
}

class DeviceCoder final : public BlockCoder {
 public:
  DeviceCoder(int device, std::function<void(const Error&)> failed)
      : state_(std::make_shared<CoderState>(device, std::move(failed))) {}

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
  use_device(device);
  return std::make_unique<DeviceCoder>(device, std::move(failed));
}

}  // namespace weir
