// Builds the macrocells of a file from some layers of 128^3 regions after the other: a window of eight cell layers for
// each, and two more, is held, however deep the volume, and no more than the volume has.
#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "compressor/encode/leaf_record.h"
#include "format/base/index.h"
#include "format/leaf/bounds.h"

namespace weir {

/// Bytes of cells that a MacrocellBuilder over `domain` and what takes its finished cells hold at once, for one layer
/// of regions at a time.
std::uint64_t macrocell_window_bytes(const Box& domain);

/// Bounds of the cells that one region can touch: its own 8^3 and one more on every side.
class RegionCells {
 public:
  explicit RegionCells(const Index3& region_node);

  /// A tile: all of `voxels`, which lie in the region and in the domain, read `value`.
  void add_tile(const Box& voxels, float value);
  /// A kept leaf whose box is `node`.
  void add_leaf(const Box& node, const LeafRecord& record);

 private:
  friend class MacrocellBuilder;
  static constexpr std::int64_t kSide = 10;

  MinMax& at(const Index3& cell);

  Index3 first_;  // cell coordinates of the lowest one
  std::vector<MinMax> cells_;
};

class MacrocellBuilder {
 public:
  /// Cells over `domain`; voxels outside it read `background`.
  MacrocellBuilder(const Box& domain, float background);

  const NodeLattice& lattice() const { return lattice_; }

  /// Moves the window to so many layers of regions from `region_z` (node coordinate) on; layers must come in order.
  void begin_layers(std::int64_t region_z, std::int64_t layers);
  /// Merges one region of the current layers. Thread-safe.
  void merge(const RegionCells& cells);
  /// Cell layers that no later region can touch, finished: consecutive layers of the lattice from
  /// `first_layer` on. Call after all regions of the layers; `last` also finishes what is left.
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
