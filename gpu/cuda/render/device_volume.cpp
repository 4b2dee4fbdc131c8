#include "gpu/cuda/render/device_volume.h"

#include <limits>
#include <memory>
#include <utility>

#include "format/base/error.h"
#include "gpu/cuda/bricks/table_source.h"
#include "gpu/cuda/volume/device_memory.h"

namespace weir {

namespace {

std::variant<DeviceTable<FloatBlock>, DeviceTable<QuantisedBlock>> make_table(const NvdbGrid& grid,
                                                                              const std::byte* data) {
  if (grid.type() == GridType::float32) return DeviceTable<FloatBlock>(grid, data);
  return DeviceTable<QuantisedBlock>(grid, data);
}

}  // namespace

DeviceVolume::DeviceVolume(const NvdbGrid& grid, GridBytes bytes, const NodeLattice& lattice, std::vector<MinMax> cells)
    : grid_(grid),
      bytes_(std::move(bytes)),
      table_(make_table(grid, bytes_.data())),
      host_cells_(cells.empty()
                      ? with_table([&](const auto& table) { return gather_macrocells(table, cell_lattice(lattice)); })
                      : std::move(cells)),
      cells_(host_cells_) {}

BrickCache* DeviceVolume::atlas() {
  if (!atlas_ && atlas_refusal_.empty()) {
    try {
      const std::uint64_t free = free_device_bytes(std::numeric_limits<std::uint64_t>::max());
      atlas_.emplace(with_table([&]<class Block>(const BlockTable<Block>& table) {
                       return std::unique_ptr<BlockSource>(std::make_unique<TableSource<Block>>(grid_, table));
                     }),
                     free > kSpareDeviceBytes ? free - kSpareDeviceBytes : 0, 0, BricksKept::all);
    } catch (const Error& error) {
      atlas_refusal_ = error.what();
    }
  }
  return atlas_ ? &*atlas_ : nullptr;
}

}  // namespace weir
