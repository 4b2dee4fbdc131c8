// A volume in the memory of a CUDA device, as what surveys and encodes its packed blocks for a conversion
// (format/packed/block_coder.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "format/base/error.h"
#include "format/base/index.h"
#include "format/packed/block_coder.h"
#include "gpu/cuda/encode/encode_call.h"

namespace weir {

/// Boxes of it that are worked on at once, by half as many threads: what these do takes longer than what the device
/// does.
inline constexpr std::size_t kMostResidentBoxes = 16;
/// What it takes of the process's memory, at most. Of a box: what a survey finds of 8,192 blocks, or the streams of
/// 4,096, and the values of as many that the host asks for, which half of the boxes have twice.
inline constexpr std::uint64_t kResidentHostBytes = kMostResidentBoxes * (std::uint64_t{24} << 20U);

/// `values`, over `voxels`, x fastest and without gaps, lie on `device`, and stay there unchanged for as long as the
/// object lives; what computes them has ended. It takes, besides, 0.5 to 1 GB of the device's memory, the most where
/// streams are as long as values: sixteen regions of 128^3 voxels are encoded at a time. Page-locked memory goes back
/// to the process's PinnedPool. What goes wrong, room that there is not among it, ends its work and is said to
/// `failed`, once. None of its axes is longer than kLongestAxis. Throws Error as use_device() does, and Error(io) where
/// there is no room for its tables.
std::unique_ptr<ResidentVolume> make_resident_volume(int device, const float* values, const Box& voxels,
                                                     std::function<void(const Error&)> failed);

}  // namespace weir
