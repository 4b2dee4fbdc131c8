// Decides whether a volume that lies on a device is surveyed and encoded there.
#pragma once

#include <algorithm>
#include <cstdint>

#include "format/base/error.h"
#include "format/base/message.h"
#include "format/base/text.h"
#include "gpu/cuda/encode/resident_volume.h"
#include "gpu/packed/coder_choice.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Returns whether the device can do so: it was chosen for coding (`coder` is not null), the conversion may take
/// `memory` bytes of the host besides what the process had, and the device accepts this kind of values.
inline bool may_stay_on_device(const SourceInfo& info, const BlockCoder* coder, std::uint64_t memory) {
  const Index3& extent = info.extent;
  return coder != nullptr && memory >= kLeastMemoryOfDevice && info.type == ScalarType::float32 &&
         info.values_as_stored() && !info.mapping.marks_missing() &&
         std::max({extent.x, extent.y, extent.z}) <= kLongestAxis;
}

/// Returns make(); if the device has no room for it, tells `notice` and returns null.
template <class Make>
auto try_resident(const Notice& notice, const Make& make) -> decltype(make()) {
  try {
    return make();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::io) throw;
    if (notice) {
      notice(
          cat("the volume does not stay on the device (", error.what(), "); it comes to the host, to the same bytes"));
    }
    return nullptr;
  }
}

}  // namespace weir
