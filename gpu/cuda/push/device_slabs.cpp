#include "gpu/cuda/push/device_slabs.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "format/base/text.h"
#include "format/process/fault.h"
#include "gpu/cuda/push/gather_planes.h"
#include "gpu/cuda/runtime/caller_stream.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {
namespace {

constexpr std::string_view kCopying = "copying a slab from the device";

}  // namespace

DeviceSlabs::DeviceSlabs(const Index3& extent, std::size_t value_bytes, std::uint64_t device_bytes, Arrived arrived)
    : extent_(extent),
      value_bytes_(value_bytes),
      arrived_(std::move(arrived)),
      plane_bytes_(static_cast<std::uint64_t>(extent.x * extent.y) * value_bytes) {
  make_slots(device_bytes);
  worker_ = std::jthread([this] { work(); });
}

DeviceSlabs::~DeviceSlabs() {
  {
    const Lock lock(mutex_);
    stopping_ = true;
    if (!failure_) failure_ = Error(ErrorKind::interrupted, "the push was given up");
  }
  changed_.notify_all();
  worker_.join();
  free_on(context_, [&] {
    slots_.clear();
    stream_.reset();
    staged_ = {};
    pinned_.reset();
  });
}

void DeviceSlabs::make_slots(std::uint64_t device_bytes) {
  if (device_bytes > 0 && device_bytes < plane_bytes_) {
    throw Error(ErrorKind::usage, cat("the device memory for slabs is ", device_bytes, " bytes, and a plane has ",
                                      plane_bytes_, "; give as much or more, or 0 for none"));
  }
  // Aims at two pieces or more if they fit: one is filled while the other is emptied.
  const std::uint64_t most = device_bytes > 0 ? std::min(kPieceBytes, device_bytes / 2) : kPieceBytes;
  piece_planes_ = std::clamp<std::int64_t>(static_cast<std::int64_t>(most / plane_bytes_), 1, extent_.z);
  const std::uint64_t piece_bytes = static_cast<std::uint64_t>(piece_planes_) * plane_bytes_;
  const std::uint64_t pieces = static_cast<std::uint64_t>(ceil_div(extent_.z, piece_planes_));
  const std::uint64_t wanted = device_bytes > 0            ? device_bytes / piece_bytes
                               : piece_bytes > kPieceBytes ? 2
                                                           : kPinnedSlots;
  const auto count = static_cast<std::size_t>(std::min(wanted, pieces));

  std::string refusal;
  pinned_ = PinnedMemory::make(device_bytes > 0 ? piece_bytes : count * piece_bytes, refusal);
  if (!pinned_) {
    throw Error(ErrorKind::io, cat("slabs cross the bus through memory that is locked: ", refusal,
                                   "; allow more (ulimit -l), free some, or push the values from host memory"));
  }
  if (device_bytes > 0) {
    staged_ = DeviceArray<std::byte>(count * piece_bytes);
    stream_.emplace();
  }
  // Addresses as the device sees them, because the device writes the slots.
  std::byte* const first = device_bytes > 0 ? staged_.data() : const_cast<std::byte*>(pinned_->device_address());
  for (std::size_t i = 0; i < count; ++i) {
    slots_.push_back({first + i * piece_bytes, CopyEvent()});
    free_.push_back(i);
  }
}

void DeviceSlabs::add(std::int64_t z0, std::int64_t nz, const DeviceValues& values, cudaStream_t callers) {
  check(values);
  const cudaStream_t stream = caller_stream(callers);
  for (std::int64_t z = 0; z < nz; z += piece_planes_) {
    const Piece piece{take_slot(), z0 + z, std::min(piece_planes_, nz - z)};
    DeviceValues part = values;
    part.first += z * values.stride[2];
    try {
      copy(piece, part, stream);
    } catch (...) {
      end_with(error_in_flight());
      cudaStreamSynchronize(stream);  // nothing may write to the slot once it is freed
      throw;
    }
    const Lock lock(mutex_);
    pieces_.push_back(piece);
    changed_.notify_all();
  }
}

std::size_t DeviceSlabs::take_slot() {
  Lock lock(mutex_);
  changed_.wait(lock, [this] { return failure_ || !free_.empty(); });
  if (failure_) throw Error(*failure_);
  const std::size_t slot = free_.back();
  free_.pop_back();
  return slot;
}

void DeviceSlabs::copy(const Piece& piece, const DeviceValues& values, cudaStream_t stream) {
  Slot& slot = slots_[piece.slot];
  const Index3 extent{extent_.x, extent_.y, piece.nz};
  if (without_gaps(values, extent)) {
    check_cuda(cudaMemcpyAsync(slot.memory, values.first, static_cast<std::uint64_t>(piece.nz) * plane_bytes_,
                               cudaMemcpyDefault, stream),
               kCopying);
  } else {
    gather_planes(values, extent, slot.memory, stream);
  }
  slot.filled.record(stream);
}

void DeviceSlabs::work() {
  try {
    context_.enter();
  } catch (...) {
    end_with(error_in_flight());
  }
  Lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || !pieces_.empty(); });
    if (pieces_.empty()) return;
    const Piece piece = pieces_.front();
    lock.unlock();
    try {
      hand_over(piece);
    } catch (...) {
      end_with(error_in_flight());
    }
    lock.lock();
    pieces_.pop_front();
    free_.push_back(piece.slot);
    changed_.notify_all();
  }
}

// Waits for the piece's copy even after a failure: it must end before the slot is used again or freed.
void DeviceSlabs::hand_over(const Piece& piece) {
  const Slot& slot = slots_[piece.slot];
  slot.filled.wait(kCopying);
  {
    const Lock lock(mutex_);
    if (failure_) return;
  }
  const std::byte* values = pinned_->data() + (slot.memory - slots_.front().memory);
  if (staged_.size() > 0) {
    check_cuda(cudaMemcpyAsync(pinned_->data(), slot.memory, static_cast<std::uint64_t>(piece.nz) * plane_bytes_,
                               cudaMemcpyDeviceToHost, stream_->get()),
               kCopying);
    check_cuda(cudaStreamSynchronize(stream_->get()), kCopying);
    values = pinned_->data();
  }
  arrived_(piece.z0, piece.nz, values);
}

void DeviceSlabs::finish() {
  Lock lock(mutex_);
  changed_.wait(lock, [this] { return pieces_.empty(); });
  if (failure_) throw Error(*failure_);
}

void DeviceSlabs::end_with(const Error& error) {
  {
    const Lock lock(mutex_);
    if (!failure_) failure_ = error;
  }
  changed_.notify_all();
}

}  // namespace weir
