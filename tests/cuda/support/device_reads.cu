#include "tests/cuda/support/device_reads.h"

#include "gpu/cuda/volume/device_samplers.h"

namespace weir::test {

namespace {

constexpr int kThreads = 128;

unsigned grid_of(std::size_t count) { return static_cast<unsigned>((count + kThreads - 1) / kThreads); }

template <class Block>
__global__ void voxels_kernel(BlockTable<Block> table, std::size_t count, float* values) {
  const std::size_t i = static_cast<std::size_t>(blockIdx.x) * kThreads + threadIdx.x;
  if (i >= count) return;
  const auto nx = static_cast<std::size_t>(table.extent.x);
  const auto ny = static_cast<std::size_t>(table.extent.y);
  values[i] = table.voxel({static_cast<std::int32_t>(i % nx), static_cast<std::int32_t>(i / nx % ny),
                           static_cast<std::int32_t>(i / (nx * ny))});
}

template <class Volume>
__global__ void smooth_kernel(Volume volume, const Float3* positions, std::size_t count, float* values) {
  const std::size_t i = static_cast<std::size_t>(blockIdx.x) * kThreads + threadIdx.x;
  if (i < count) values[i] = volume.smooth(positions[i]);
}

template <class Volume>
__global__ void mean_kernel(Volume volume, const Float3* positions, std::size_t count, int draws, float* values) {
  const std::size_t i = static_cast<std::size_t>(blockIdx.x) * kThreads + threadIdx.x;
  if (i >= count) return;
  Random random(1, i, 0);
  double sum = 0;
  for (int k = 0; k < draws; ++k) sum += volume.sample(positions[i], random);
  values[i] = static_cast<float>(sum / draws);
}

template <class Volume>
std::vector<float> smooth(const Volume& volume, const std::vector<Float3>& positions) {
  const DeviceArray<Float3> at(std::span<const Float3>{positions});
  const DeviceArray<float> values(positions.size());
  smooth_kernel<<<grid_of(positions.size()), kThreads, 0, cudaStreamPerThread>>>(volume, at.data(), positions.size(),
                                                                                 values.data());
  check_cuda(cudaGetLastError(), "reading");
  return values.download();
}

template <class Volume>
std::vector<float> mean(const Volume& volume, const std::vector<Float3>& positions, int draws) {
  const DeviceArray<Float3> at(std::span<const Float3>{positions});
  const DeviceArray<float> values(positions.size());
  mean_kernel<<<grid_of(positions.size()), kThreads, 0, cudaStreamPerThread>>>(volume, at.data(), positions.size(),
                                                                               draws, values.data());
  check_cuda(cudaGetLastError(), "reading");
  return values.download();
}

}  // namespace

template <class Block>
std::vector<float> read_voxels(const BlockTable<Block>& table) {
  const std::size_t count = static_cast<std::size_t>(table.extent.x) * static_cast<std::size_t>(table.extent.y) *
                            static_cast<std::size_t>(table.extent.z);
  const DeviceArray<float> values(count);
  voxels_kernel<<<grid_of(count), kThreads, 0, cudaStreamPerThread>>>(table, count, values.data());
  check_cuda(cudaGetLastError(), "reading");
  return values.download();
}

template <class Block>
std::vector<float> read_smooth(const BlockTable<Block>& table, Filter filter, const std::vector<Float3>& positions) {
  if (filter == Filter::nearest) return smooth(TableSampler<Block, Filter::nearest>{table}, positions);
  return smooth(TableSampler<Block, Filter::trilinear>{table}, positions);
}

std::vector<float> read_smooth(BrickCache& bricks, Filter filter, const std::vector<Float3>& positions) {
  if (filter == Filter::nearest) return smooth(bricks.sampler<Filter::nearest>(), positions);
  return smooth(bricks.sampler<Filter::trilinear>(), positions);
}

std::vector<float> read_stochastic(BrickCache& bricks, const std::vector<Float3>& positions, int draws) {
  return mean(bricks.sampler<Filter::stochastic>(), positions, draws);
}

template <class Block>
std::vector<float> read_stochastic(const BlockTable<Block>& table, const std::vector<Float3>& positions, int draws) {
  return mean(TableSampler<Block, Filter::stochastic>{table}, positions, draws);
}

template std::vector<float> read_voxels(const BlockTable<FloatBlock>&);
template std::vector<float> read_voxels(const BlockTable<QuantisedBlock>&);
template std::vector<float> read_smooth(const BlockTable<FloatBlock>&, Filter, const std::vector<Float3>&);
template std::vector<float> read_smooth(const BlockTable<QuantisedBlock>&, Filter, const std::vector<Float3>&);
template std::vector<float> read_stochastic(const BlockTable<FloatBlock>&, const std::vector<Float3>&, int);
template std::vector<float> read_stochastic(const BlockTable<QuantisedBlock>&, const std::vector<Float3>&, int);

}  // namespace weir::test
