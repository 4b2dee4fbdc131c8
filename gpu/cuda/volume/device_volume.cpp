#include "gpu/cuda/volume/device_volume.h"

#include <utility>

#include "format/base/error.h"

namespace weir {

GridBytes::GridBytes(const GridBytes& other, int other_device, int device) : copy_(other.bytes()) {
  check_cuda(cudaMemcpyPeer(copy_.data(), device, other.data(), other_device, other.bytes()),
             "copying a grid to another device");
}

DeviceBuffer GridBytes::take_buffer() && {
  return loaded_ ? std::move(*std::exchange(loaded_, std::nullopt)).take_buffer() : DeviceBuffer{};
}

namespace {

std::variant<DeviceTable<FloatBlock>, DeviceTable<QuantisedBlock>> make_table(const NvdbGrid& grid,
                                                                              const std::byte* data) {
  if (grid.type() == GridType::float32) return DeviceTable<FloatBlock>(grid, data);
  return DeviceTable<QuantisedBlock>(grid, data);
}

}  // namespace

DeviceVolume::DeviceVolume(const NvdbGrid& grid, GridBytes bytes, const NodeLattice& lattice, std::vector<MinMax> cells)
    : bytes_(std::move(bytes)),
      table_(make_table(grid, bytes_.data())),
      host_cells_(cells.empty()
                      ? with_table([&](const auto& table) { return gather_macrocells(table, cell_lattice(lattice)); })
                      : std::move(cells)),
      cells_(host_cells_) {}

const BrickAtlas* DeviceVolume::atlas() {
  if (!atlas_ && atlas_refusal_.empty()) {
    try {
      atlas_.emplace(with_table([](const auto& table) { return BrickAtlas(table, kSpareDeviceBytes); }));
    } catch (const Error& error) {
      atlas_refusal_ = error.what();
    }
  }
  return atlas_ ? &*atlas_ : nullptr;
}

}  // namespace weir
