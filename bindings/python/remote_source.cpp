#include "bindings/python/remote_source.h"

#include "format/nanovdb/read_box.h"

namespace weir::python {

RemoteSource::RemoteSource(const RemoteGrid& grid) : grid_(grid) {
  const NvdbGrid& head = grid.grid();
  info_.path = grid.path();
  info_.format = "nanovdb";
  info_.dataset = head.name();
  info_.extent = head.index_bbox().extent();
  info_.index_origin = head.index_bbox().lo;
  info_.spacing = head.voxel_size();
  info_.origin = head.world_origin();
  info_.file_bytes = grid.bytes();
}

AccessShape RemoteSource::access() const { return {sizeof(float), {kLeafDim, kLeafDim, kLeafDim}, {0, 0, 0}}; }

ConversionLoss RemoteSource::read(const Box& box, std::span<float> values) {
  read_box(grid_.grid(), box, values);
  return {};
}

}  // namespace weir::python
