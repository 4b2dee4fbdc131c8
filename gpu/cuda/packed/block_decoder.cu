#include "gpu/cuda/packed/block_decoder.h"

#include <algorithm>
#include <array>

#include "format/base/error.h"
#include "gpu/cuda/packed/decode_steps.h"

namespace weir {
namespace {

constexpr unsigned kMostThreads = 320;
constexpr unsigned kPlainThreads = 64;

constexpr ScanPlaces kScanPlaces = make_scan_places();

__constant__ ScanPlaces scan_places;
__device__ BlockScan device_scan;

struct DeviceThread {
  __device__ unsigned index() const { return threadIdx.x; }
  __device__ unsigned count() const { return blockDim.x; }
  __device__ unsigned group() const { return blockIdx.x; }
  __device__ unsigned groups() const { return gridDim.x; }
  __device__ void meet() const { __syncthreads(); }
  __device__ void meet_warp() const { __syncwarp(); }
  __device__ std::uint32_t add(std::uint32_t* counter, std::uint32_t n) const { return atomicAdd(counter, n); }
};

__global__ void decode_together(DecodeCall call) {
  extern __shared__ __align__(16) unsigned char shared[];
  decode_blocks(DeviceThread{}, call, scan_places, device_scan, shared);
}

__global__ void decode_plainly(DecodeCall call) { decode_left(DeviceThread{}, call, device_scan); }

__global__ void count_left(std::uint32_t* counters) {
  counters[2] += counters[1];
  counters[1] = 0;
}

int attribute(cudaDeviceAttr wanted, int device) {
  int value = 0;
  check_cuda(cudaDeviceGetAttribute(&value, wanted, device), "asking for the device");
  return value;
}

}  // namespace

BlockDecoder::BlockDecoder(const PackedData& packed)
    : data_(packed.bytes()), tables_(packed.header().frequencies), left_(kMostBlocks), counters_(3) {
  const PackedHeader& header = packed.header();
  view_.data = data_.data();
  view_.bytes = packed.bytes().size();
  view_.table = header.table;
  view_.regions = static_cast<std::uint64_t>(header.regions.size());
  view_.constants = header.values;
  view_.constants.tables = tables_.data();
  counters_.upload(std::array<std::uint32_t, 3>{});
  check_cuda(cudaMemcpyToSymbol(scan_places, &kScanPlaces, sizeof kScanPlaces), "copying to the device");
  check_cuda(cudaMemcpyToSymbol(device_scan, &kBlockScan, sizeof kBlockScan), "copying to the device");
  int device = 0;
  check_cuda(cudaGetDevice(&device), "asking for the device");
  const auto shared = static_cast<unsigned>(attribute(cudaDevAttrMaxSharedMemoryPerBlockOptin, device));
  threads_ = kMostThreads;
  while (threads_ > kWarp && decode_layout(threads_).bytes > shared) threads_ -= kWarp;
  shared_bytes_ = decode_layout(threads_).bytes;
  check_cuda(cudaFuncSetAttribute(decode_together, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                  static_cast<int>(shared_bytes_)),
             "reserving shared memory");
  groups_ = static_cast<unsigned>(attribute(cudaDevAttrMultiProcessorCount, device));
}

void BlockDecoder::decode(const PackedBlockId* blocks, std::size_t count, float* values, cudaStream_t stream) {
  if (count == 0) return;
  if (count > kMostBlocks) throw Error(ErrorKind::internal, "more blocks than one call decodes");
  const DecodeCall call{view_, blocks, static_cast<std::uint32_t>(count), values, left_.data(), counters_.data()};
  const unsigned groups = std::min(groups_, (call.count + threads_ - 1) / threads_);
  decode_together<<<groups, threads_, shared_bytes_, stream>>>(call);
  decode_plainly<<<8 * groups_, kPlainThreads, 0, stream>>>(call);
  count_left<<<1, 1, 0, stream>>>(counters_.data());
  check_cuda(cudaGetLastError(), "decoding blocks");
}

BlockDecoder::Counts BlockDecoder::counts(cudaStream_t stream) {
  std::array<std::uint32_t, 3> found{};
  check_cuda(cudaMemcpyAsync(found.data(), counters_.data(), counters_.bytes(), cudaMemcpyDeviceToHost, stream),
             "copying from the device");
  check_cuda(cudaMemsetAsync(counters_.data(), 0, counters_.bytes(), stream), "clearing device memory");
  check_cuda(cudaStreamSynchronize(stream), "decoding blocks");
  return {found[0], found[2]};
}

}  // namespace weir
