#include "gpu/cuda/render/device_volume.h"

#include <algorithm>
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

DeviceVolume::DeviceVolume(const NvdbGrid& grid, GridBytes bytes, const NodeLattice& lattice, std::vector<MinMax> cells,
                           std::uint64_t memory)
    : grid_(grid),
      memory_(memory),
      bytes_(std::move(bytes)),
      table_(make_table(grid, bytes_.data())),
      host_cells_(cells.empty()
                      ? with_table([&](const auto& table) { return gather_macrocells(table, cell_lattice(lattice)); })
                      : std::move(cells)),
      cells_(host_cells_) {}

template <class Block>
void DeviceVolume::make_atlas(const BlockTable<Block>& table) {
  const auto blocks = static_cast<std::uint64_t>(leaf_lattice(grid_.index_bbox()).size());
  const std::uint64_t wanted = blocks * (kBrickTexels * texel_bytes(TexelType::share16) + 2 * sizeof(BrickEntry));
  const std::uint64_t free = free_device_bytes(wanted + kSpareDeviceBytes);
  const std::uint64_t taken = bytes_.device_bytes() + blocks * sizeof(Block) + cells_.bytes();
  BrickBudget budget;
  budget.bytes =
      std::min(memory_ > taken ? memory_ - taken : 0, free > kSpareDeviceBytes ? free - kSpareDeviceBytes : 0);
  atlas_.emplace(std::make_unique<TableSource<Block>>(grid_, table), budget, BricksKept::all);
}

BrickCache* DeviceVolume::atlas() {
  if (!atlas_ && atlas_refusal_.empty()) {
    try {
      with_table([&]<class Block>(const BlockTable<Block>& table) { make_atlas(table); });
    } catch (const Error& error) {
      atlas_refusal_ = error.what();
    }
  }
  return atlas_ ? &*atlas_ : nullptr;
}

bool DeviceVolume::drop_atlas(const std::string& why) {
  if (!atlas_) return false;
  atlas_.reset();
  atlas_refusal_ = why;
  atlas_dropped_ = true;
  return true;
}

}  // namespace weir
