#include "gpu/cuda/render/refused_memory.h"

#include "format/base/text.h"

namespace weir {

Error refused_error(const Message& place, const DeviceFull& refused, const std::string& remedies) {
  return {refused.kind(), compose(place, ": ", refused.message(), "; ", remedies, remedies.empty() ? "" : ", ",
                                  "end what else uses the device, or give ", option("backend", "cpu"))};
}

bool make_room(BrickVolume& volume, const DeviceFull& refused) {
  return volume.shrink(refused.bytes(), refused.what());
}

bool make_room(DeviceVolume& volume, const DeviceFull& refused) { return volume.drop_atlas(refused.what()); }

namespace {

std::string less_memory(const std::string& refusal) {
  return cat("the device has less memory than was meant for the volume (", refusal, "); ");
}

}  // namespace

std::string memory_note(const BrickCache& cache) {
  if (cache.refusal().empty()) return "";
  return cat(less_memory(cache.refusal()), "a cache of ", cache.bricks(), " bricks, ", format_bytes(cache.bytes()),
             ", does with less, and more slowly");
}

std::string memory_note(const DeviceVolume& volume) {
  if (!volume.atlas_dropped()) return "";
  return less_memory(volume.atlas_refusal()) + "its voxels are looked up without bricks, more slowly";
}

}  // namespace weir
