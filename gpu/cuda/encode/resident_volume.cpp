#include "gpu/cuda/encode/resident_volume.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "gpu/cuda/encode/coder_state.h"
#include "gpu/cuda/encode/device_blocks.h"
#include "gpu/cuda/encode/launch.h"

namespace weir {
namespace {

class DeviceVolume final : public ResidentVolume {
 public:
  DeviceVolume(int device, const float* values, const Box& voxels, std::function<void(const Error&)> failed)
      : state_(std::make_shared<CoderState>(device, kMostResidentBoxes, std::move(failed))),
        values_(values),
        voxels_(voxels) {}

  const Box& voxels() const override { return voxels_; }

  std::unique_ptr<ResidentBlocks> open(const Box& blocks) override {
    std::optional<BlockBox> box = block_box(voxels_, blocks);
    if (!box) return nullptr;
    box->values = values_;
    return state_->attempt([&]() -> std::unique_ptr<ResidentBlocks> {
      std::unique_ptr<BoxMemory> memory = state_->boxes.take();
      if (!memory) return nullptr;
      return std::make_unique<DeviceBlocks>(state_, std::move(memory), *box, place_of(blocks));
    });
  }

  std::unique_ptr<ResidentBlocks> open_rows(std::span<const Box> rows) override {
    std::optional<BlockBox> box = block_box(voxels_, rows.front());
    const std::vector<BlockRow> places = block_rows(voxels_, make_lattice(voxels_, kLeafDim), rows);
    if (!box || places.empty()) return nullptr;
    assert(box->blocks[1] == 1 && box->blocks[2] == 1);
    box->values = values_;
    box->blocks[1] = static_cast<std::uint32_t>(places.size());
    return state_->attempt([&]() -> std::unique_ptr<ResidentBlocks> {
      std::unique_ptr<BoxMemory> memory = state_->boxes.take();
      if (!memory) return nullptr;
      return std::make_unique<DeviceBlocks>(state_, std::move(memory), *box, places);
    });
  }

  std::size_t most_open() const override { return kMostResidentBoxes; }

  std::optional<std::vector<std::uint64_t>> count(int exponent, double base, std::size_t bins) override {
    if (bins > kMostCountedBins) return std::nullopt;
    return state_->attempt([&]() -> std::optional<std::vector<std::uint64_t>> {
      const std::vector<unsigned long long> none(bins);
      const DeviceArray<unsigned long long> counts(none);
      launch_count({values_, static_cast<std::uint64_t>(voxels_.voxels()), std::ldexp(1.0, -exponent), base,
                    static_cast<std::uint32_t>(bins), counts.data()},
                   cudaStreamPerThread);
      const std::vector<unsigned long long> found = counts.download();
      return std::vector<std::uint64_t>(found.begin(), found.end());
    });
  }

  void expect_streams(std::size_t regions) override {
    try {
      const KeptDevice kept(state_->context);
      std::array<std::unique_ptr<StreamMemory>, kMostResidentBoxes> held;
      const auto taken = std::span(held).first(std::min(regions, held.size()));
      for (std::unique_ptr<StreamMemory>& memory : taken) {
        memory = state_->streams.take();
        memory->hold(StreamMemory::kRegionBlocks, StreamMemory::kRegionBytes, true);
      }
      for (std::unique_ptr<StreamMemory>& memory : taken) state_->streams.give_back(std::move(memory));
    } catch (const std::exception&) {
      // The next call that needs the memory reports the failure.
    }
  }

  void free_memory() override {
    free_on(state_->context, [&] {
      state_->boxes.clear();
      state_->streams.clear();
    });
  }

  void read(const Box& box, std::span<float> values) override {
    const char* const what = "copying values from the device";
    const KeptDevice kept(state_->context);
    const Index3 extent = voxels_.extent();
    const Index3 from = box.lo - voxels_.lo;
    const Index3 size = box.extent();
    const auto count = [](std::int64_t n) { return static_cast<std::size_t>(n); };
    cudaMemcpy3DParms parts{};
    parts.srcPtr = {const_cast<float*>(values_), count(extent.x) * sizeof(float), count(extent.x), count(extent.y)};
    parts.srcPos = {count(from.x) * sizeof(float), count(from.y), count(from.z)};
    parts.dstPtr = {values.data(), count(size.x) * sizeof(float), count(size.x), count(size.y)};
    parts.extent = {count(size.x) * sizeof(float), count(size.y), count(size.z)};
    parts.kind = cudaMemcpyDeviceToHost;
    check_cuda(cudaMemcpy3DAsync(&parts, cudaStreamPerThread), what);
    check_cuda(cudaStreamSynchronize(cudaStreamPerThread), what);
  }

  std::uint64_t host_bytes() const override { return kResidentHostBytes; }

 private:
  BlockPlace place_of(const Box& blocks) const {
    const Index3 corner{floor_div(blocks.lo.x, kLeafDim), floor_div(blocks.lo.y, kLeafDim),
                        floor_div(blocks.lo.z, kLeafDim)};
    const NodeLattice lattice = make_lattice(voxels_, kLeafDim);
    const Index3 first = corner - lattice.first;
    const auto odd = [](std::int64_t v) { return v % 2 != 0 ? 1U : 0U; };
    return {
        {first.x, first.y, first.z}, {lattice.count.x, lattice.count.y}, {odd(corner.x), odd(corner.y), odd(corner.z)}};
  }

  std::shared_ptr<CoderState> state_;
  const float* values_;
  Box voxels_;
};

}  // namespace

std::unique_ptr<ResidentVolume> make_resident_volume(int device, const float* values, const Box& voxels,
                                                     std::function<void(const Error&)> failed) {
  check_device(device);
  const KeptDevice kept(device);
  return std::make_unique<DeviceVolume>(device, values, voxels, std::move(failed));
}

}  // namespace weir
