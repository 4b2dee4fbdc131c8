// A grid on one device with all that rendering needs there.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "gpu/cuda/bricks/brick_cache.h"
#include "gpu/cuda/volume/device_macrocells.h"
#include "gpu/cuda/volume/device_table.h"
#include "gpu/cuda/volume/grid_bytes.h"

namespace weir {

/// Must be made and used with its device current.
class DeviceVolume {
 public:
  /// `grid` must outlive the object. `cells` are the bounds of macrocells. They are empty if the file has none; then
  /// the constructor gathers them.
  DeviceVolume(const NvdbGrid& grid, GridBytes bytes, const NodeLattice& lattice, std::vector<MinMax> cells,
               std::uint64_t memory = ~std::uint64_t{0});

  const GridBytes& bytes() const { return bytes_; }
  GridBytes take_bytes() && { return std::move(bytes_); }
  /// Calls visit(BlockTable<...>) with the volume's table.
  template <class Visit>
  decltype(auto) with_table(const Visit& visit) const {
    return std::visit([&](const auto& table) -> decltype(auto) { return visit(table.view()); }, table_);
  }
  const std::vector<MinMax>& host_cells() const { return host_cells_; }
  DeviceMacrocells& cells() { return cells_; }
  /// Returns all blocks as bricks, made at the first call. Returns null if the device has no room for them;
  /// `atlas_refusal` then gives the reason.
  BrickCache* atlas();
  const std::string& atlas_refusal() const { return atlas_refusal_; }
  /// Drops the atlas for good, because the device has refused another allocation for the reason `why`. Returns false
  /// if there is no atlas.
  bool drop_atlas(const std::string& why);
  bool atlas_dropped() const { return atlas_dropped_; }

 private:
  template <class Block>
  void make_atlas(const BlockTable<Block>& table);

  const NvdbGrid& grid_;
  std::uint64_t memory_;
  GridBytes bytes_;
  std::variant<DeviceTable<FloatBlock>, DeviceTable<QuantisedBlock>> table_;
  std::vector<MinMax> host_cells_;
  DeviceMacrocells cells_;
  std::optional<BrickCache> atlas_;
  std::string atlas_refusal_;
  bool atlas_dropped_ = false;
};

}  // namespace weir
