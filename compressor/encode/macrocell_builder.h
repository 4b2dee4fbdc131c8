// Builds the macrocells of a file from 128^3 regions, a few layers of regions at a time. However deep the volume is,
// the builder holds only a window of cell layers: eight for each layer of regions, plus two, but no more than the
// volume has.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "compressor/encode/leaf_record.h"
#include "format/base/index.h"
#include "format/leaf/bounds.h"

namespace weir {

/// Returns the bytes of cells that a MacrocellBuilder over `domain` and the receiver of its finished cells hold at
/// once, for one layer of regions at a time.
std::uint64_t macrocell_window_bytes(const Box& domain);

/// Bounds of the cells that one region can touch: its own 8^3 cells and one more cell on every side.
class RegionCells {
 public:
  explicit RegionCells(const Index3& region_node);

  /// Adds a tile: all of `voxels`, which must lie in the region and in the domain, have the value `value`.
  void add_tile(const Box& voxels, float value);
  /// Adds a kept leaf with the box `node`.
  void add_leaf(const Box& node, const LeafRecord& record);

 private:
  friend class MacrocellBuilder;
  static constexpr std::int64_t kSide = 10;

  MinMax& at(const Index3& cell);

  Index3 first_;  // coordinates of the lowest cell
  std::vector<MinMax> cells_;
};

class MacrocellBuilder {
 public:
  /// Makes the cells over `domain`. Voxels outside it have the value `background`.
  MacrocellBuilder(const Box& domain, float background);

  const NodeLattice& lattice() const { return lattice_; }

  /// Moves the window to `layers` layers of regions from `region_z` (node coordinate) on. Layers must come in order.
  void begin_layers(std::int64_t region_z, std::int64_t layers);
  /// Merges one region of the current layers. Thread-safe.
  void merge(const RegionCells& cells);
  /// Returns the finished cell layers, which no later region can touch: consecutive layers of the lattice, from
  /// `first_layer` on. Call it after all regions of the current layers are merged. `last` also finishes the rest.
  std::vector<MinMax> take_finished(bool last, std::int64_t& first_layer);

 private:
  std::int64_t plane() const { return lattice_.count.x * lattice_.count.y; }  // cells of a layer
  void finish(std::int64_t layer, MinMax* cells) const;

  NodeLattice lattice_;
  float background_;
  std::mutex mutex_;
  std::int64_t window_first_ = 0;  // lattice z of the window's lowest layer
  std::int64_t settled_ = 0;       // the lowest layer that later regions can touch
  std::vector<MinMax> window_;
};

}  // namespace weir
