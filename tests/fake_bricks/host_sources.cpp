// Blocks of packed grids for bricks and levels of detail, over what instead/ has in place of the device; stock grids
// are for a device alone.
#include <cuda_runtime_api.h>

#include "format/base/error.h"
#include "gpu/cuda/bricks/table_source.h"
#include "gpu/cuda/volume/device_macrocells.h"
#include "gpu/cuda/volume/device_table.h"
#include "tests/fake_cuda/fake_array.h"

// Marks of nvcc.
#undef __device__
#define __device__

namespace weir {

template <class Texel>
Texel surf3Dread(cudaSurfaceObject_t surface, std::int32_t x_bytes, std::int32_t y, std::int32_t z) {
  return test::array_of(surface).read<Texel>({x_bytes / static_cast<std::int32_t>(sizeof(Texel)), y, z});
}

}  // namespace weir

// NOLINTBEGIN(bugprone-suspicious-include)
#include "gpu/cuda/bricks/device_pyramid.cu"
#include "gpu/cuda/bricks/packed_source.cu"
#include "gpu/cuda/bricks/table_source.cu"
// NOLINTEND(bugprone-suspicious-include)

namespace weir {

DeviceTransfer::DeviceTransfer(const TransferFunction& transfer)
    : table_(std::span<const Rgba>(transfer.table())),
      opacities_(std::span<const float>(transfer.opacities().levels())),
      view_(transfer.view()),
      entries_(static_cast<std::uint32_t>(transfer.table().size())) {}

OpacityBounds DeviceTransfer::bounds() const {
  TransferFunctionView view = view_;
  view.table = table_.data();
  return {view, {opacities_.data(), entries_}};
}

void DeviceMacrocells::update(const DeviceTransfer& transfer, cudaStream_t /*stream*/) {
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    majorants_.data()[i] = transfer.bounds().max_opacity(bounds_.data()[i].min, bounds_.data()[i].max);
  }
}

template <class Block>
std::vector<MinMax> gather_macrocells(const BlockTable<Block>&, const CellLattice&) {
  throw Error(ErrorKind::internal, "only packed grids are drawn here");
}
template std::vector<MinMax> gather_macrocells(const BlockTable<FloatBlock>&, const CellLattice&);
template std::vector<MinMax> gather_macrocells(const BlockTable<QuantisedBlock>&, const CellLattice&);

template <class Block>
DeviceTable<Block>::DeviceTable(const NvdbGrid&, const std::byte*) {
  throw Error(ErrorKind::internal, "only packed grids are drawn here");
}
template class DeviceTable<FloatBlock>;
template class DeviceTable<QuantisedBlock>;

}  // namespace weir
