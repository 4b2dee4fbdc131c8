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

/// Boxes of it that are worked on at once.
inline constexpr std::size_t kMostResidentBoxes = 8;
/// What it takes of the process's memory, at most. Of a box: what a survey finds of 4,096 blocks, or their streams, and
/// the values of as many that the host asks for.
inline constexpr std::uint64_t kResidentHostBytes = kMostResidentBoxes * (std::uint64_t{40} << 20U);

/// `values`, over `voxels`, x fastest and without gaps, lie on `device`, and stay there unchanged for as long as the
/// object lives; what computes them has ended. It takes, besides, some 70 bytes of the device's memory for each voxel
/// of a region of 128^3 that is encoded, of eight at a time: 1.2 GB. What goes wrong, room that there is not among it,
/// ends its work and is said to `failed`, once. None of its axes is longer than kLongestAxis. Throws Error as
/// use_device() does, and Error(io) where there is no room for its tables.
std::unique_ptr<ResidentVolume> make_resident_volume(int device, const float* values, const Box& voxels,
                                                     std::function<void(const Error&)> failed);

}  // namespace weir
