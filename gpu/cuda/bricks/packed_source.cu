#include "gpu/cuda/bricks/packed_source.h"

#include "format/base/error.h"
#include "gpu/cuda/bricks/device_machine.cuh"
#include "gpu/cuda/bricks/packed_pages.h"

namespace weir {

PackedSource::PackedSource(const NvdbGrid& grid, const std::byte* data)
    : packed_(*grid.packed()),
      lattice_(block_lattice(grid.index_bbox())),
      decoder_(packed_, data + (packed_.bytes().data() - grid.data().data())) {}

std::vector<RegionEntry> PackedSource::regions() const { return packed_regions(packed_); }

void PackedSource::fill_pages(const std::uint32_t* regions, const std::uint32_t* pages, std::uint32_t count,
                              const PageTable& table) {
  DeviceMachine{}.each(kRegionBlocks * count, FillPages<PackedBlocks>{{decoder_.view()}, table, regions, pages});
}

void PackedSource::decode(const BlockId* blocks, std::uint32_t count, float* values) {
  decoder_.decode(blocks, count, values, cudaStreamPerThread);
}

void PackedSource::check() {
  damaged_ += decoder_.counts(cudaStreamPerThread).damaged;
  if (damaged_ == 0) return;
  throw Error(ErrorKind::input, cat(packed_.path(), ": ", damaged_, " packed blocks are damaged; see weir verify"));
}

}  // namespace weir
