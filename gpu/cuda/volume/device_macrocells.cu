#include "gpu/cuda/volume/device_macrocells.h"

#include "gpu/cuda/runtime/launch_kernel.cuh"

namespace weir {

namespace {

constexpr int kThreads = 256;

/// Sets the first and last voxel, inclusive, of a cell with its apron along one axis, inside the domain.
__device__ void reach(std::int32_t cell, std::int32_t edge, std::int32_t shift, std::int32_t extent, std::int32_t& low,
                      std::int32_t& high) {
  low = greater(cell * edge - shift - 1, 0);
  high = lesser((cell + 1) * edge - shift, extent - 1);
}

/// One block of threads per cell.
template <class Block>
__global__ void gather(BlockTable<Block> table, CellLattice cells, MinMax* bounds) {
  const auto edge = static_cast<std::int32_t>(cells.edge);
  const std::int64_t cell = blockIdx.x;
  const auto cx = static_cast<std::int32_t>(cell % cells.count.x);
  const auto cy = static_cast<std::int32_t>(cell / cells.count.x % cells.count.y);
  const auto cz = static_cast<std::int32_t>(cell / (static_cast<std::int64_t>(cells.count.x) * cells.count.y));
  Int3 low;
  Int3 high;
  reach(cx, edge, cells.shift.x, table.extent.x, low.x, high.x);
  reach(cy, edge, cells.shift.y, table.extent.y, low.y, high.y);
  reach(cz, edge, cells.shift.z, table.extent.z, low.z, high.z);
  const std::int32_t nx = high.x - low.x + 1;
  const std::int32_t ny = high.y - low.y + 1;
  const std::int64_t count = static_cast<std::int64_t>(nx) * ny * (high.z - low.z + 1);
  float least = kInfinity;
  float most = -kInfinity;
  for (std::int64_t i = threadIdx.x; i < count; i += kThreads) {
    // z fastest, as in leaves
    const auto nz = high.z - low.z + 1;
    const Int3 voxel{low.x + static_cast<std::int32_t>(i / (static_cast<std::int64_t>(nz) * ny)),
                     low.y + static_cast<std::int32_t>(i / nz % ny), low.z + static_cast<std::int32_t>(i % nz)};
    const float value = table.voxel(voxel);
    if (!is_finite(value)) continue;
    least = lesser(least, value);
    most = greater(most, value);
  }
  __shared__ MinMax of_warps[kThreads / 32];
  for (int distance = 16; distance > 0; distance /= 2) {
    least = lesser(least, __shfl_down_sync(~0U, least, distance));
    most = greater(most, __shfl_down_sync(~0U, most, distance));
  }
  if (threadIdx.x % 32 == 0) of_warps[threadIdx.x / 32] = {least, most};
  __syncthreads();
  if (threadIdx.x != 0) return;
  for (const MinMax& warp : of_warps) {
    least = lesser(least, warp.min);
    most = greater(most, warp.max);
  }
  bounds[cell] = {least, most};
}

__global__ void find_majorants(OpacityBounds transfer, const MinMax* bounds, std::size_t count, float* majorants) {
  const std::size_t i = static_cast<std::size_t>(blockIdx.x) * kThreads + threadIdx.x;
  if (i < count) majorants[i] = transfer.max_opacity(bounds[i].min, bounds[i].max);
}

}  // namespace

template <class Block>
std::vector<MinMax> gather_macrocells(const BlockTable<Block>& table, const CellLattice& cells) {
  const DeviceArray<MinMax> bounds(static_cast<std::size_t>(cells.size()));
  launch_kernel("gathering macrocells", {static_cast<unsigned>(cells.size()), kThreads, cudaStreamPerThread},
                gather<Block>, table, cells, bounds.data());
  return bounds.download();
}

template std::vector<MinMax> gather_macrocells(const BlockTable<FloatBlock>&, const CellLattice&);
template std::vector<MinMax> gather_macrocells(const BlockTable<QuantisedBlock>&, const CellLattice&);

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

void DeviceTransfer::replace(const TransferFunction& transfer) {
  if (transfer.table().size() != entries_) {
    *this = DeviceTransfer(transfer);
    return;
  }
  table_.upload(transfer.table());
  opacities_.upload(transfer.opacities().levels());
  view_ = transfer.view();
}

void DeviceMacrocells::update(const DeviceTransfer& transfer, cudaStream_t stream) {
  const auto blocks = static_cast<unsigned>((bounds_.size() + kThreads - 1) / kThreads);
  launch_kernel("finding majorants", {blocks, kThreads, stream}, find_majorants, transfer.bounds(), bounds_.data(),
                bounds_.size(), majorants_.data());
}

}  // namespace weir
