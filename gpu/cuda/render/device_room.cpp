#include "gpu/cuda/render/device_room.h"

#include <algorithm>

#include "format/base/message.h"
#include "format/base/text.h"
#include "gpu/cuda/volume/block_table.h"
#include "gpu/cuda/volume/device_memory.h"
#include "gpu/volume/leaf_table.h"

namespace weir {

namespace {

std::uint64_t block_count(const NvdbGrid& grid) {
  return static_cast<std::uint64_t>(leaf_lattice(grid.index_bbox()).size());
}

/// Returns roughly the bytes of the bricks of a grid that is not packed: two bricks per leaf, its own and a
/// neighbour.
std::uint64_t brick_bytes_of(const NvdbGrid& grid) {
  const std::uint64_t bricks = std::min<std::uint64_t>(block_count(grid), std::uint64_t{2} * grid.node_counts()[0]);
  return bricks * (kBrickTexels * sizeof(std::uint16_t)) + 2 * block_count(grid) * sizeof(BrickEntry);
}

/// Returns the bytes that a grid takes on a device with room, without its bricks.
std::uint64_t bytes_needed(const NvdbGrid& grid) {
  // Streams may take half of the room: look-ups read a packed grid's bricks, so these need the other half.
  if (grid.packed() != nullptr) return 2 * grid.data_bytes();
  const bool floats = grid.type() == GridType::float32;
  return grid.data_bytes() + block_count(grid) * (floats ? sizeof(FloatBlock) : sizeof(QuantisedBlock));
}

DeviceRoom room_without_levels(const NvdbGrid& grid, const CudaOptions& options, std::uint64_t held) {
  if (options.memory) return {*options.memory / options.volumes, 0, options.volumes, true};
  const std::uint64_t bricks =
      grid.packed() != nullptr ? block_count(grid) * (kBrickTexels * sizeof(float) + sizeof(BrickEntry)) : 0;
  const std::uint64_t wanted = bytes_needed(grid) + bricks + kSpareDeviceBytes;
  const std::uint64_t free = free_device_bytes(wanted > held ? wanted - held : 0) + held;
  const std::uint64_t bytes = free > kSpareDeviceBytes ? free - kSpareDeviceBytes : 0;
  // A cache takes all it gets, and the next volume of a series needs as much.
  const std::uint64_t share = device_bytes() / options.volumes;
  if (grid.packed() == nullptr && bytes_needed(grid) <= bytes) return {bytes, free, options.volumes, false};
  return {std::min(bytes, share), std::min(free, share + kSpareDeviceBytes), options.volumes, false};
}

}  // namespace

DeviceRoom room_for(const NvdbGrid& grid, const CudaOptions& options, std::uint64_t held) {
  DeviceRoom room = room_without_levels(grid, options, held);
  if (options.levels) room.levels = bytes_for_levels(room.bytes);
  return room;
}

std::string reason_for_zero_copy(const NvdbGrid& grid, const DeviceRoom& room) {
  std::uint64_t needed = bytes_needed(grid);
  // Levels of detail are made from bricks. It is better to keep the leaves in host memory than to have few bricks
  // beside them.
  if (room.levels > 0 && grid.packed() == nullptr) needed += brick_bytes_of(grid);
  if (needed <= room.bytes - room.levels) return "";
  const std::string with_levels = room.levels > 0 ? " without what is kept for levels of detail" : "";
  if (room.limited) {
    return compose("the grid needs ", format_bytes(room.volumes * needed), " of device memory, more than ",
                   option("device-memory", format_bytes(room.volumes * room.bytes)), with_levels,
                   ", so it stays in host memory")
        .text();
  }
  return cat("the grid needs ", format_bytes(needed + kSpareDeviceBytes), " of device memory and ",
             format_bytes(room.free), " are free", with_levels, ", so it stays in host memory");
}

bool worth_bricks(const NvdbGrid& grid, std::uint64_t memory) {
  return grid.packed() != nullptr || memory >= grid.data_bytes() / 10;
}

}  // namespace weir
