// Macrocells in device memory: their bounds, gathered on the device if a file has none, and the majorants that a
// transfer function gives them.
#pragma once

#include <cuda_runtime_api.h>

#include <utility>

#include "gpu/cuda/runtime/device_array.h"
#include "gpu/cuda/volume/block_table.h"
#include "gpu/volume/macrocell_grid.h"

namespace weir {

/// Returns the bounds of the finite values of each cell of `cells` and one voxel around it, inside the table's
/// domain, x fastest. A cell without finite values has {infinity, -infinity}.
template <class Block>
std::vector<MinMax> gather_macrocells(const BlockTable<Block>& table, const CellLattice& cells);

/// A transfer function as kernels look it up.
class DeviceTransfer {
 public:
  explicit DeviceTransfer(const TransferFunction& transfer);

  OpacityBounds bounds() const;
  /// Replaces the function by one with the same number of entries: two small copies.
  void replace(const TransferFunction& transfer);

 private:
  DeviceArray<Rgba> table_;
  DeviceArray<float> opacities_;
  TransferFunctionView view_;
  std::uint32_t entries_ = 0;
};

class DeviceMacrocells {
 public:
  explicit DeviceMacrocells(const std::vector<MinMax>& bounds) : bounds_(bounds), majorants_(bounds.size()) {}
  explicit DeviceMacrocells(DeviceArray<MinMax> bounds) : bounds_(std::move(bounds)), majorants_(bounds_.size()) {}

  const MinMax* bounds() const { return bounds_.data(); }
  /// Returns the largest opacity of each cell, as of the last update.
  const float* majorants() const { return majorants_.data(); }
  std::size_t size() const { return bounds_.size(); }
  void update(const DeviceTransfer& transfer, cudaStream_t stream);
  std::uint64_t bytes() const { return bounds_.bytes() + majorants_.bytes(); }

 private:
  DeviceArray<MinMax> bounds_;
  DeviceArray<float> majorants_;
};

}  // namespace weir
