// A volume in the memory of a CUDA device, whose packed blocks the device surveys and encodes for a conversion
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

/// Boxes of the volume that are worked on at once, by half as many threads: the threads' work takes longer than the
/// device's.
inline constexpr std::size_t kMostResidentBoxes = 16;
/// Most bytes of the process's memory. A box takes what a survey finds of 8,192 blocks, or the streams of 4,096; it
/// also takes the values of as many blocks that the host asks for, twice in half of the boxes.
inline constexpr std::uint64_t kResidentHostBytes = kMostResidentBoxes * (std::uint64_t{24} << 20U);

/// `values`, over `voxels`, x fastest and without gaps, lie on `device`. They stay there unchanged as long as the
/// object lives, and the work that computes them has ended. The object takes another 0.5 to 1 GB of device memory,
/// the most if streams are as long as values: sixteen regions of 128^3 voxels are encoded at a time. Page-locked
/// memory goes back to the process's PinnedPool. A failure, including a lack of memory, ends the object's work and is
/// passed to `failed` once. No axis is longer than kLongestAxis. Throws the errors of use_device(), and Error(io) if
/// there is no room for the tables.
std::unique_ptr<ResidentVolume> make_resident_volume(int device, const float* values, const Box& voxels,
                                                     std::function<void(const Error&)> failed);

}  // namespace weir
