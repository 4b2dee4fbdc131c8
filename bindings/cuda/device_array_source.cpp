#include "bindings/cuda/device_array_source.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "gpu/cuda/load/pinned_memory.h"
#include "gpu/cuda/push/device_slabs.h"
#include "gpu/cuda/push/device_values.h"
#include "gpu/cuda/push/gather_planes.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/current_device.h"

namespace weir {
namespace {

constexpr const char* kCopyingBox = "copying a box from the device";

class DeviceArraySource final : public VolumeSource {
 public:
  /// `device` is the current device.
  DeviceArraySource(const DenseArray& array, int device)
      : array_(array),
        context_(device),
        info_(array_info(array)),
        value_bytes_(static_cast<std::int64_t>(scalar_bytes(array.type))),
        piece_bytes_(std::max(DeviceSlabs::kPieceBytes, static_cast<std::uint64_t>(array.extent.x * value_bytes_))) {
    check_slab(values_at({0, 0, 0}), device);
    std::string refusal;
    pinned_ = PinnedMemory::make(working_bytes(), refusal);
    if (!pinned_) throw Error(ErrorKind::io, refusal);
    for (std::size_t i = 0; i < DeviceSlabs::kPinnedSlots; ++i) free_.push_back(i);
  }

  ~DeviceArraySource() override {
    free_on(context_, [&] { pinned_.reset(); });
  }
  DeviceArraySource(const DeviceArraySource&) = delete;
  DeviceArraySource& operator=(const DeviceArraySource&) = delete;

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {static_cast<std::size_t>(value_bytes_), {}, {}}; }
  std::uint64_t working_bytes() const override { return DeviceSlabs::kPinnedSlots * piece_bytes_; }
  std::uint64_t bytes_read() const override { return bytes_read_; }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    const KeptDevice kept(context_);
    const Index3 extent = box.extent();
    const std::int64_t most = static_cast<std::int64_t>(piece_bytes_) / value_bytes_;
    const std::int64_t rows = std::clamp<std::int64_t>(most / extent.x, 1, extent.y);
    const std::int64_t planes = rows < extent.y ? 1 : std::clamp<std::int64_t>(most / (extent.x * rows), 1, extent.z);
    ConversionLoss loss;
    for (std::int64_t z = box.lo.z; z < box.hi.z; z += planes) {
      for (std::int64_t y = box.lo.y; y < box.hi.y; y += rows) {
        const Box piece{{box.lo.x, y, z}, {box.hi.x, std::min(y + rows, box.hi.y), std::min(z + planes, box.hi.z)}};
        const auto first = static_cast<std::size_t>(linear_index(piece.lo - box.lo, extent));
        loss.add(read_piece(piece, values.subspan(first, static_cast<std::size_t>(piece.voxels()))));
      }
    }
    return loss;
  }

 private:
  // One of the pieces of page-locked memory, held while the object lives.
  class Slot {
   public:
    explicit Slot(DeviceArraySource& source) : source_(source) {
      std::unique_lock lock(source_.mutex_);
      source_.freed_.wait(lock, [this] { return !source_.free_.empty(); });
      number_ = source_.free_.back();
      source_.free_.pop_back();
    }
    ~Slot() {
      const std::lock_guard lock(source_.mutex_);
      source_.free_.push_back(number_);
      source_.freed_.notify_one();
    }
    Slot(const Slot&) = delete;
    Slot& operator=(const Slot&) = delete;
    std::size_t offset() const { return number_ * source_.piece_bytes_; }

   private:
    DeviceArraySource& source_;
    std::size_t number_;
  };

  DeviceValues values_at(const Index3& i) const {
    const auto* const first = static_cast<const std::byte*>(array_.data) + i.x * array_.stride[0] +
                              i.y * array_.stride[1] + i.z * array_.stride[2];
    return {first, array_.stride, static_cast<std::size_t>(value_bytes_)};
  }

  ConversionLoss read_piece(const Box& piece, std::span<float> values) {
    const Slot slot(*this);
    const Index3 extent = piece.extent();
    const DeviceValues from = values_at(piece.lo);
    const auto bytes = static_cast<std::uint64_t>(piece.voxels() * value_bytes_);
    std::byte* const host = pinned_->data() + slot.offset();
    if (without_gaps(from, extent)) {
      check_cuda(cudaMemcpyAsync(host, from.first, bytes, cudaMemcpyDefault, cudaStreamPerThread), kCopyingBox);
    } else {
      gather_planes(from, extent, const_cast<std::byte*>(pinned_->device_address()) + slot.offset(),
                    cudaStreamPerThread);
    }
    check_cuda(cudaStreamSynchronize(cudaStreamPerThread), kCopyingBox);
    bytes_read_ += bytes;
    DenseArray stored = array_;
    stored.data = host;
    stored.extent = extent;
    stored.stride = packed_stride(extent, array_.type);
    return open_array(stored)->read({{0, 0, 0}, extent}, values);
  }

  const DenseArray array_;
  const SharedContext context_;
  const SourceInfo info_;
  const std::int64_t value_bytes_;
  const std::uint64_t piece_bytes_;
  std::optional<PinnedMemory> pinned_;
  std::atomic<std::uint64_t> bytes_read_{0};
  std::mutex mutex_;  // guards the members below
  std::condition_variable freed_;
  std::vector<std::size_t> free_;
};

}  // namespace

int device_of(const void* address) {
  if (device_count() == 0)
    throw Error(ErrorKind::usage,
                "source lies on a CUDA device, and none answers here; copy it to a numpy array first");
  const std::optional<DevicePlace> place = device_place(address);
  if (!place) {
    throw Error(
        ErrorKind::usage,
        "source says that it lies on a CUDA device, and its address is no memory of one; give the array itself");
  }
  return place->device;
}

std::unique_ptr<VolumeSource> open_device_array(const DenseArray& array, int device) {
  const KeptDevice kept(device);
  return std::make_unique<DeviceArraySource>(array, device);
}

}  // namespace weir
