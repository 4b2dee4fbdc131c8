// A grid on one device with all that rendering it needs there.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "gpu/cuda/grid_loader.h"
#include "gpu/cuda/volume/brick_atlas.h"
#include "gpu/cuda/volume/device_macrocells.h"
#include "gpu/cuda/volume/device_table.h"

namespace weir {

/// Device memory left for pictures, environments and other programs.
inline constexpr std::uint64_t kSpareDeviceBytes = 512ULL << 20U;

/// A grid's bytes on a device: loaded from its file, or copied from another device.
class GridBytes {
 public:
  explicit GridBytes(DeviceGrid loaded) : loaded_(std::move(loaded)) {}
  /// Copies from `other_device` to `device`, the current one.
  GridBytes(const GridBytes& other, int other_device, int device);

  const std::byte* data() const { return loaded_ ? loaded_->data() : copy_.data(); }
  std::uint64_t bytes() const { return loaded_ ? loaded_->bytes() : copy_.bytes(); }
  /// For the next load; empty where this is a copy.
  DeviceBuffer take_buffer() &&;

 private:
  std::optional<DeviceGrid> loaded_;
  DeviceArray<std::byte> copy_;
};

/// Made and used with its device current.
class DeviceVolume {
 public:
  /// `cells`: bounds of macrocells; empty where the file has none and they are gathered here.
  DeviceVolume(const NvdbGrid& grid, GridBytes bytes, const NodeLattice& lattice, std::vector<MinMax> cells);

  const GridBytes& bytes() const { return bytes_; }
  GridBytes take_bytes() && { return std::move(bytes_); }
  /// Calls visit(BlockTable<...>) with the one there is.
  template <class Visit>
  decltype(auto) with_table(const Visit& visit) const {
    return std::visit([&](const auto& table) -> decltype(auto) { return visit(table.view()); }, table_);
  }
  const std::vector<MinMax>& host_cells() const { return host_cells_; }
  DeviceMacrocells& cells() { return cells_; }
  /// Built at the first call; null where the device has no room for it, with the reason in `atlas_refusal`.
  const BrickAtlas* atlas();
  const std::string& atlas_refusal() const { return atlas_refusal_; }

 private:
  GridBytes bytes_;
  std::variant<DeviceTable<FloatBlock>, DeviceTable<QuantisedBlock>> table_;
  std::vector<MinMax> host_cells_;
  DeviceMacrocells cells_;
  std::optional<BrickAtlas> atlas_;
  std::string atlas_refusal_;
};

}  // namespace weir
