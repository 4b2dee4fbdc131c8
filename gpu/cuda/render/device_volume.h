// A grid on one device with all that rendering it needs there.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "gpu/cuda/bricks/brick_cache.h"
#include "gpu/cuda/volume/device_macrocells.h"
#include "gpu/cuda/volume/device_table.h"
#include "gpu/cuda/volume/grid_bytes.h"

namespace weir {

/// Made and used with its device current.
class DeviceVolume {
 public:
  /// `grid` must outlive the object. `cells`: bounds of macrocells; empty where the file has none and they are gathered
  /// here.
  DeviceVolume(const NvdbGrid& grid, GridBytes bytes, const NodeLattice& lattice, std::vector<MinMax> cells,
               std::uint64_t memory = ~std::uint64_t{0});

  const GridBytes& bytes() const { return bytes_; }
  GridBytes take_bytes() && { return std::move(bytes_); }
  /// Calls visit(BlockTable<...>) with the one there is.
  template <class Visit>
  decltype(auto) with_table(const Visit& visit) const {
    return std::visit([&](const auto& table) -> decltype(auto) { return visit(table.view()); }, table_);
  }
  const std::vector<MinMax>& host_cells() const { return host_cells_; }
  DeviceMacrocells& cells() { return cells_; }
  /// All blocks as bricks, made at the first call; null where the device has no room for that, with the reason in
  /// `atlas_refusal`.
  BrickCache* atlas();
  const std::string& atlas_refusal() const { return atlas_refusal_; }
  /// Does without the atlas from now on, since the device has refused something else for the reason `why`; false where
  /// there is none.
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
