#include "ingest/hdf5/storage/chunk_components.h"

#include <algorithm>
#include <cstring>

namespace weir {

ChunkComponents chunk_components(const VoxelComponents& components, std::int64_t in_chunk) {
  const ComponentChoice& choice = components.choice;
  if (choice.magnitude || components.count == 1) return {in_chunk, 0, components};
  const std::int64_t position = choice.position % in_chunk;
  return {in_chunk, choice.position - position, {in_chunk, {false, position}}};
}

ComponentGathering::ComponentGathering(const ChunkComponents& components, std::span<const std::byte> fill,
                                       std::span<std::byte> into)
    : components_(components), fill_(fill), into_(into) {}

void ComponentGathering::add(std::span<const std::byte> chunk) {
  const std::int64_t used = std::min(components_.in_chunk, components_.read.count - done_);
  const std::size_t value = fill_.size();
  const std::size_t room = components_.voxel_bytes(value);
  const std::size_t voxels = into_.size() / room;
  std::byte* const to = into_.data() + static_cast<std::size_t>(done_) * value;
  if (chunk.empty()) {
    for (std::size_t i = 0; i < voxels * static_cast<std::size_t>(used); ++i) {
      const auto numbers = static_cast<std::size_t>(used);
      std::memcpy(to + i / numbers * room + i % numbers * value, fill_.data(), value);
    }
  } else {
    const std::size_t step = static_cast<std::size_t>(components_.in_chunk) * value;
    const std::size_t width = static_cast<std::size_t>(used) * value;
    for (std::size_t i = 0; i < voxels; ++i) std::memcpy(to + i * room, chunk.data() + i * step, width);
    any_stored_ = true;
  }
  done_ += used;
}

std::span<const std::byte> ComponentGathering::gathered() const {
  return any_stored_ ? into_ : std::span<const std::byte>();
}

}  // namespace weir
