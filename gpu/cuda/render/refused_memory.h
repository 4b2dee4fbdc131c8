// What becomes of loads and pictures that a device refuses memory.
#pragma once

#include <string>

#include "format/base/message.h"
#include "gpu/cuda/render/brick_volume.h"
#include "gpu/cuda/render/device_volume.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {

/// "PLACE: REFUSED; REMEDIES, end what else uses the device, or give --backend cpu", of the refusal's kind.
Error refused_error(const Message& place, const DeviceFull& refused, const std::string& remedies = "");

/// A volume gives back what it can do without, for a picture that was refused memory: some of its bricks, or its atlas.
/// False where there is no such thing. Throws as BrickCache::shrink.
bool make_room(BrickVolume& volume, const DeviceFull& refused);
bool make_room(DeviceVolume& volume, const DeviceFull& refused);

/// Picture::memory_note of one of the volume.
std::string memory_note(const BrickCache& cache);
std::string memory_note(const DeviceVolume& volume);

}  // namespace weir
