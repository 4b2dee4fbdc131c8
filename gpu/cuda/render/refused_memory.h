// What happens to loads and pictures if a device refuses memory.
#pragma once

#include <string>

#include "format/base/message.h"
#include "gpu/cuda/render/brick_volume.h"
#include "gpu/cuda/render/device_volume.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {

/// Returns an error of the refusal's kind: "PLACE: REFUSED; REMEDIES, end what else uses the device, or give
/// --backend cpu".
Error refused_error(const Message& place, const DeviceFull& refused, const std::string& remedies = "");

/// Makes the volume give back what it can do without, some bricks or its atlas, for a picture that was refused
/// memory. Returns false if there is nothing to give back. Throws the errors of BrickCache::shrink.
bool make_room(BrickVolume& volume, const DeviceFull& refused);
bool make_room(DeviceVolume& volume, const DeviceFull& refused);

/// Returns the Picture::memory_note for a picture of the volume.
std::string memory_note(const BrickCache& cache);
std::string memory_note(const DeviceVolume& volume);

}  // namespace weir
