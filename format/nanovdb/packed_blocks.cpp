#include "format/nanovdb/packed_blocks.h"

namespace weir {
namespace {

GridBlock block_of(const Index3& origin, const PackedRegion& region, const PackedStream& stream) {
  return {origin, kLeafDim, true, stream.data == nullptr ? region.value : 0.0F, nullptr, stream};
}

GridBlock whole_region(const Index3& origin, const PackedRegion& region) {
  return {origin, kLowerDim, true, region.value, nullptr, {}};
}

}  // namespace

GridBlock packed_block_at(const PackedData& data, float background, const Index3& i) {
  const NodeLattice& regions = data.regions();
  const Index3 node = floor_div(i, kLowerDim);
  const Index3 position = node - regions.first;
  if (!Box{{0, 0, 0}, regions.count}.contains(position)) {
    return {node * kLowerDim, kLowerDim, false, background, nullptr, {}};
  }
  const PackedRegion region = data.region(position);
  if (region.chunk == 0) return whole_region(node * kLowerDim, region);
  const Index3 block = floor_div(i, kLeafDim);
  return block_of(block * kLeafDim, region, data.stream(region, packed_position(block)));
}

void for_each_packed_block(const PackedData& data, const Index3& position,
                           const std::function<void(const GridBlock&)>& visit) {
  const NodeLattice& regions = data.regions();
  const Index3 corner = regions.node_box(position).lo;
  const PackedRegion region = data.region(position);
  if (region.chunk == 0) return visit(whole_region(corner, region));
  data.for_each_stream(region, [&](unsigned at, const PackedStream& stream) {
    const Index3 origin = corner + packed_block(at) * kLeafDim;
    const Box block{origin, origin + Index3{kLeafDim, kLeafDim, kLeafDim}};
    if (!intersect(block, regions.domain).empty()) visit(block_of(origin, region, stream));
  });
}

void for_each_packed_block(const PackedData& data, const std::function<void(const GridBlock&)>& visit) {
  for_each_index({{0, 0, 0}, data.regions().count},
                 [&](const Index3& position) { for_each_packed_block(data, position, visit); });
}

}  // namespace weir
