#include "gpu/cuda/encode/device_blocks.h"

#include <algorithm>
#include <utility>

#include "gpu/cuda/encode/launch.h"
#include "gpu/volume/block_lattice.h"

namespace weir {
namespace {

template <class T>
void copy_back(std::span<T> to, const T* from, cudaStream_t stream, const char* what) {
  check_cuda(cudaMemcpyAsync(to.data(), from, to.size_bytes(), cudaMemcpyDeviceToHost, stream), what);
}

// Hands out parts of one piece of memory, one after the other, each aligned for its type.
class Parts {
 public:
  template <class T>
  static std::size_t bytes(std::size_t count) {
    return (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
  }
  explicit Parts(std::byte* memory) : next_(memory) {}
  template <class T>
  std::span<T> next(std::size_t count) {
    T* const first = reinterpret_cast<T*>(next_);
    next_ += bytes<T>(count);
    return {first, count};
  }

 private:
  static constexpr std::size_t kAlignment = 16;
  std::byte* next_;
};

class DeviceStreams final : public PendingStreams {
 public:
  /// `place` is given for resident blocks; their decoded values stay on the device. Results come back to `pinned` or,
  /// if that is null, to the object's own memory.
  DeviceStreams(std::shared_ptr<CoderState> coder, const BlockBox& box, const std::optional<BlockPlace>& place,
                std::span<const StreamAsk> asks, const BlockConstants& constants, GrowingPinned* pinned)
      : coder_(std::move(coder)), memory_(coder_->context, coder_->streams, coder_->streams.take()) {
    const std::size_t count = asks.size();
    const std::size_t bytes = std::size_t{asks.back().offset} + asks.back().bytes;
    // Resident blocks come region by region.
    memory_->hold(place ? std::max(count, StreamMemory::kRegionBlocks) : count,
                  place ? std::max(bytes, StreamMemory::kRegionBytes) : bytes, place.has_value());
    EncodeCall call;
    call.box = box;
    call.constants = constants;
    call.constants.tables = nullptr;
    call.tables = coder_->costs.data();
    call.codes = coder_->codes.data();
    StreamAsk* const asked = memory_->asks.data();
    call.asks = asked;
    call.count = static_cast<std::uint32_t>(count);
    call.on_lattices = std::any_of(asks.begin(), asks.end(),
                                   [](const StreamAsk& ask) { return ask.kind != StreamAskKind::transform; });
    call.states = memory_->states.data();
    call.coded = memory_->coded.data();
    call.words = memory_->words.data();
    call.decoded = memory_->decoded.data();
    call.out = memory_->out.data();
    call.made = memory_->made.data();
    const std::size_t of_host = place ? 0 : 512 * count;  // decoded values
    const std::size_t recorded = place ? count : 0;
    if (pinned == nullptr) pinned = &memory_->pinned;
    Parts parts(pinned->at_least(Parts::bytes<float>(of_host) + Parts::bytes<LeafRecord>(recorded) +
                                 Parts::bytes<Digest>(recorded) + Parts::bytes<std::uint8_t>(count) +
                                 Parts::bytes<std::byte>(bytes)));
    const auto decoded = parts.next<float>(of_host);
    const auto records = parts.next<LeafRecord>(recorded);
    const auto sources = parts.next<Digest>(recorded);
    const auto made = parts.next<std::uint8_t>(count);
    const auto streams = parts.next<std::byte>(bytes);
    const cudaStream_t stream = memory_->stream.get();
    check_cuda(cudaMemcpyAsync(asked, asks.data(), asks.size_bytes(), cudaMemcpyHostToDevice, stream),
               "copying to the device");
    launch_encode(call, stream);
    const char* const what = "encoding on the device";
    if (place) {
      LeafRecord* const found = memory_->records.data();
      Digest* const digests = memory_->sources.data();
      launch_records({box, *place, coder_->digests.data(), asked, call.count, call.decoded, found, digests}, stream);
      copy_back(records, found, stream, what);
      copy_back(sources, digests, stream, what);
    } else {
      copy_back(decoded, call.decoded, stream, what);
    }
    copy_back(made, call.made, stream, what);
    copy_back(streams, call.out, stream, what);
    memory_->done.record(stream);
    found_ = {streams, decoded, made, records, sources};
  }

  std::optional<MadeStreams> wait() override {
    return coder_->attempt([&]() -> std::optional<MadeStreams> {
      memory_->done.wait("encoding on the device");
      return found_;
    });
  }

 private:
  std::shared_ptr<CoderState> coder_;
  Lent<StreamMemory> memory_;
  MadeStreams found_;
};

}  // namespace

std::optional<BlockBox> block_box(const Box& voxels, const Box& blocks) {
  BlockBox box;
  const Index3 extent = voxels.extent();
  const Index3 corner = blocks.lo - voxels.lo;
  const Index3 count = blocks.extent();
  constexpr std::int64_t kMost = kLongestAxis;
  const std::int64_t all[3][3] = {
      {extent.x, corner.x, count.x}, {extent.y, corner.y, count.y}, {extent.z, corner.z, count.z}};
  for (int axis = 0; axis < 3; ++axis) {
    if (all[axis][0] > kMost || all[axis][2] > kMost) return std::nullopt;
    box.extent[axis] = static_cast<std::int32_t>(all[axis][0]);
    box.corner[axis] = static_cast<std::int32_t>(all[axis][1]);
    box.blocks[axis] = static_cast<std::uint32_t>(all[axis][2] / kLeafDim);
  }
  return box;
}

std::vector<BlockRow> block_rows(const Box& voxels, const NodeLattice& lattice, std::span<const Box> rows) {
  std::vector<BlockRow> places;
  for (const Box& row : rows) {
    const std::optional<BlockBox> box = block_box(voxels, row);
    if (!box) return {};
    const Index3 first{floor_div(row.lo.x, kLeafDim), floor_div(row.lo.y, kLeafDim), floor_div(row.lo.z, kLeafDim)};
    places.push_back({lattice.linear(first - lattice.first), {box->corner[0], box->corner[1], box->corner[2]}, 0});
  }
  return places;
}

DeviceBlocks::DeviceBlocks(std::shared_ptr<CoderState> coder, std::unique_ptr<BoxMemory> memory,
                           std::span<const float> values, const BlockBox& box)
    : coder_(std::move(coder)), memory_(coder_->context, coder_->boxes, std::move(memory)), box_(box) {
  float* const to = memory_->values.at_least(values.size());
  box_.values = to;
  const cudaStream_t stream = memory_->stream.get();
  check_cuda(cudaMemcpyAsync(to, values.data(), values.size_bytes(), cudaMemcpyHostToDevice, stream),
             "copying to the device");
  // Other streams read the values, and the caller may change its copy.
  check_cuda(cudaStreamSynchronize(stream), "copying to the device");
}

DeviceBlocks::DeviceBlocks(std::shared_ptr<CoderState> coder, std::unique_ptr<BoxMemory> memory, const BlockBox& box,
                           const BlockPlace& place)
    : coder_(std::move(coder)), memory_(coder_->context, coder_->boxes, std::move(memory)), box_(box), place_(place) {}

DeviceBlocks::DeviceBlocks(std::shared_ptr<CoderState> coder, std::unique_ptr<BoxMemory> memory, const BlockBox& box,
                           std::span<const BlockRow> rows)
    : DeviceBlocks(std::move(coder), std::move(memory), box, BlockPlace{}) {
  BlockRow* const to = memory_->rows.at_least(rows.size());
  box_.rows = to;
  const char* const what = "copying to the device";
  const cudaStream_t stream = memory_->stream.get();
  check_cuda(cudaMemcpyAsync(to, rows.data(), rows.size_bytes(), cudaMemcpyHostToDevice, stream), what);
  check_cuda(cudaStreamSynchronize(stream), what);  // the caller may change its copy
}

void DeviceBlocks::begin_survey(const RungAsk& ask) {
  begun_ = coder_->attempt([&]() -> std::optional<SurveyedBlocks> {
    const std::size_t count = box_.count();
    SurveyCall call;
    call.box = box_;
    call.tables = coder_->costs.data();
    call.ask = ask;
    const std::size_t rungs = ask.most() * count;
    call.figures = memory_->figures.at_least(count);
    call.costs = memory_->costs.at_least(rungs);
    const std::size_t nearly = ask.near.most() * count;
    const std::size_t summarized = place_ ? count : 0;
    Parts parts(memory_->pinned.at_least(Parts::bytes<BlockFigures>(count) + Parts::bytes<RungCost>(rungs) +
                                         Parts::bytes<NearCost>(nearly) + Parts::bytes<BlockSummary>(summarized)));
    const auto figures = parts.next<BlockFigures>(count);
    const auto costs = parts.next<RungCost>(rungs);
    const auto near = parts.next<NearCost>(nearly);
    const auto summaries = parts.next<BlockSummary>(summarized);
    const cudaStream_t stream = memory_->stream.get();
    const char* const what = "surveying on the device";
    launch_survey(call, stream);
    if (nearly > 0) {
      const NearCall of_near{box_,         call.tables, coder_->codes.data(),          ask,
                             call.figures, call.costs,  memory_->near.at_least(nearly)};
      launch_near_survey(of_near, stream);
      copy_back(near, of_near.costs, stream, what);
    }
    copy_back(figures, call.figures, stream, what);
    copy_back(costs, call.costs, stream, what);
    if (place_) {
      BlockSummary* const found = memory_->summaries.at_least(count);
      launch_summaries({box_, *place_, coder_->digests.data(), found}, stream);
      copy_back(summaries, found, stream, what);
    }
    memory_->done.record(stream);
    return SurveyedBlocks{figures, costs, near, summaries};
  });
}

std::optional<SurveyedBlocks> DeviceBlocks::end_survey() {
  if (!begun_) return std::nullopt;
  return coder_->attempt([&]() -> std::optional<SurveyedBlocks> {
    memory_->done.wait("surveying on the device");
    return begun_;
  });
}

std::unique_ptr<PendingStreams> DeviceBlocks::encode(std::span<const StreamAsk> asks, const BlockConstants& constants) {
  return coder_->attempt([&]() -> std::unique_ptr<PendingStreams> {
    // A box of resident blocks has the streams of one region, encoded after the survey, so both share the box's
    // memory.
    GrowingPinned* const pinned = place_ ? &memory_->pinned : nullptr;
    return std::make_unique<DeviceStreams>(coder_, box_, place_, asks, constants, pinned);
  });
}

std::optional<std::span<const float>> DeviceBlocks::values(std::span<const std::uint32_t> blocks) {
  return coder_->attempt([&]() -> std::optional<std::span<const float>> {
    const char* const what = "copying blocks from the device";
    const cudaStream_t stream = memory_->stream.get();
    std::uint32_t* const wanted = memory_->wanted.at_least(blocks.size());
    check_cuda(cudaMemcpyAsync(wanted, blocks.data(), blocks.size_bytes(), cudaMemcpyHostToDevice, stream), what);
    float* const found = memory_->values.at_least(512 * blocks.size());
    launch_values({box_, wanted, static_cast<std::uint32_t>(blocks.size()), found}, stream);
    const std::span<float> values(
        reinterpret_cast<float*>(memory_->wanted_values.at_least(512 * blocks.size() * sizeof(float))),
        512 * blocks.size());
    copy_back(values, found, stream, what);
    memory_->done.record(stream);
    memory_->done.wait(what);
    return values;
  });
}

}  // namespace weir
