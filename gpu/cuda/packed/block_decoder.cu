#include "gpu/cuda/packed/block_decoder.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "format/base/error.h"
#include "gpu/cuda/packed/decode_steps.h"
#include "gpu/cuda/runtime/launch_kernel.cuh"

namespace weir {
namespace {

constexpr std::string_view kDecoding = "decoding blocks";
// Most blocks that are decoded at a time.
constexpr std::size_t kBatch = std::size_t{1} << 18U;
constexpr unsigned kSortThreads = 256;
constexpr unsigned kNarrowThreads = 768;  // more threads leave the cache too little room for their streams
constexpr unsigned kWideThreads = 512;
constexpr unsigned kValueThreads = 256;
constexpr unsigned kValueGroups = 4;  // per multiprocessor

__constant__ ScanSteps scan_steps;
__device__ BlockScan device_scan;
__device__ Diagonals diagonals;

struct DeviceThread {
  __device__ unsigned index() const { return threadIdx.x; }
  __device__ unsigned count() const { return blockDim.x; }
  __device__ unsigned group() const { return blockIdx.x; }
  __device__ unsigned groups() const { return gridDim.x; }
  __device__ void meet() const { __syncthreads(); }
  __device__ void meet_warp() const { __syncwarp(); }
  __device__ bool any_of_warp(bool own) const { return __any_sync(~0U, own) != 0; }
  __device__ void prefetch(const void* at) const { asm volatile("prefetch.global.L2 [%0];" ::"l"(at)); }
  __device__ std::uint32_t add(std::uint32_t* counter, std::uint32_t n) const { return atomicAdd(counter, n); }
};

__global__ void make_tables(const std::uint16_t* frequencies, unsigned char* tables) {
  decode_detail::SharedTables(tables).fill(DeviceThread{}, device_scan, frequencies);
}

__global__ void __launch_bounds__(kSortThreads) look_at(DecodeCall call) {
  __shared__ std::uint32_t shared[decode_detail::kBins];
  look_at_blocks(DeviceThread{}, call, shared);
}

__global__ void __launch_bounds__(kSortThreads) put_in_order(DecodeCall call) {
  __shared__ std::uint32_t shared[2 * decode_detail::kBins];
  order_blocks(DeviceThread{}, call, shared);
}

extern __shared__ __align__(16) unsigned char shared_bytes[];

__global__ void __launch_bounds__(kNarrowThreads, 1) take_narrow(DecodeCall call) {
  take_magnitudes<std::uint16_t>(DeviceThread{}, call, scan_steps, shared_bytes);
}

__global__ void __launch_bounds__(kWideThreads, 1) take_wide(DecodeCall call) {
  take_magnitudes<std::uint32_t>(DeviceThread{}, call, scan_steps, shared_bytes);
}

template <class Slot>
__global__ void __launch_bounds__(kValueThreads, kValueGroups) values_of(DecodeCall call) {
  __shared__ float stage[kValueThreads / kWarp][kStageWords];
  make_values<Slot>(DeviceThread{}, call, device_scan, diagonals, stage[threadIdx.x / kWarp]);
}

int attribute(cudaDeviceAttr wanted, int device) {
  int value = 0;
  check_cuda(cudaDeviceGetAttribute(&value, wanted, device), "asking for the device");
  return value;
}

// Returns the most threads, up to `most`, that the device's shared memory has room for.
template <class Slot, class Kernel>
unsigned fitting_threads(Kernel kernel, unsigned most, int device) {
  const auto shared = static_cast<unsigned>(attribute(cudaDevAttrMaxSharedMemoryPerBlockOptin, device));
  while (most > kWarp && magnitude_bytes<Slot>(most) > shared) most -= kWarp;
  check_cuda(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                                  static_cast<int>(magnitude_bytes<Slot>(most))),
             "reserving shared memory");
  return most;
}

}  // namespace

BlockDecoder::BlockDecoder(const PackedData& packed, const std::byte* data)
    : frequencies_(packed.header().frequencies),
      tables_(decode_detail::SharedTables::kBytes),
      tasks_(kBatch),
      order_(kBatch),
      overflown_(kBatch),
      counts_(1),
      totals_(2) {
  if (data == nullptr || reinterpret_cast<std::uintptr_t>(data) % 16 != 0) {
    data_ = DeviceArray<std::byte>((packed.bytes().size() + 15) / 16 * 16);
    data_.upload(packed.bytes());
    data = data_.data();
  }
  totals_.upload(std::array<std::uint32_t, 2>{});
  const PackedHeader& header = packed.header();
  view_.data = data;
  view_.bytes = packed.bytes().size();
  view_.table = header.table;
  view_.regions = static_cast<std::uint64_t>(header.regions.size());
  view_.constants = header.values;
  view_.constants.tables = frequencies_.data();
  check_cuda(cudaMemcpyToSymbol(scan_steps, &kScanSteps, sizeof kScanSteps), "copying to the device");
  check_cuda(cudaMemcpyToSymbol(device_scan, &kBlockScan, sizeof kBlockScan), "copying to the device");
  check_cuda(cudaMemcpyToSymbol(diagonals, &kDiagonals, sizeof kDiagonals), "copying to the device");
  launch_kernel("making tables", {1, kNarrowThreads, cudaStreamPerThread}, make_tables, frequencies_.data(),
                tables_.data());
  check_cuda(cudaStreamSynchronize(cudaStreamPerThread), "making tables");
  int device = 0;
  check_cuda(cudaGetDevice(&device), "asking for the device");
  processors_ = static_cast<unsigned>(attribute(cudaDevAttrMultiProcessorCount, device));
  narrow_threads_ = fitting_threads<std::uint16_t>(take_narrow, kNarrowThreads, device);
  wide_threads_ = fitting_threads<std::uint32_t>(take_wide, kWideThreads, device);
}

void BlockDecoder::decode(const BlockId* blocks, std::size_t most, const std::uint32_t* count_on_device, float* values,
                          cudaStream_t stream) {
  for (std::size_t first = 0; first < most; first += kBatch) {
    DecodeCall call;
    call.view = view_;
    call.tables = tables_.data();
    call.blocks = blocks + first;
    call.most = static_cast<std::uint32_t>(std::min(most - first, kBatch));
    call.available = count_on_device;
    call.first = static_cast<std::uint32_t>(first);
    call.values = values + 512 * first;
    call.tasks = tasks_.data();
    call.order = order_.data();
    call.overflown = overflown_.data();
    call.counts = counts_.data();
    call.totals = totals_.data();
    const auto groups = [&](unsigned blocks_of_group, unsigned most_groups) {
      return std::min((call.most + blocks_of_group - 1) / blocks_of_group, most_groups);
    };
    check_cuda(cudaMemsetAsync(counts_.data(), 0, counts_.bytes(), stream), "clearing device memory");
    const LaunchShape sort{groups(kSortThreads, 8 * processors_), kSortThreads, stream};
    launch_kernel(kDecoding, sort, look_at, call);
    launch_kernel(kDecoding, sort, put_in_order, call);
    launch_kernel(
        kDecoding,
        {groups(kWarp, processors_), narrow_threads_, stream, magnitude_bytes<std::uint16_t>(narrow_threads_)},
        take_narrow, call);
    // A few wide blocks take nearly as long as many, so they run beside the narrow ones.
    side_.leave(stream);
    launch_kernel(
        kDecoding,
        {groups(kWarp, processors_), wide_threads_, side_.get(), magnitude_bytes<std::uint32_t>(wide_threads_)},
        take_wide, call);
    const unsigned value_groups = groups(kValueThreads / kWarp, kValueGroups * processors_);
    launch_kernel(kDecoding, {value_groups, kValueThreads, side_.get()}, values_of<std::uint32_t>, call);
    launch_kernel(kDecoding, {value_groups, kValueThreads, stream}, values_of<std::uint16_t>, call);
    side_.join(stream);
  }
}

BlockDecoder::Counts BlockDecoder::counts(cudaStream_t stream) {
  std::array<std::uint32_t, 2> found{};
  check_cuda(cudaMemcpyAsync(found.data(), totals_.data(), totals_.bytes(), cudaMemcpyDeviceToHost, stream),
             "copying from the device");
  check_cuda(cudaMemsetAsync(totals_.data(), 0, totals_.bytes(), stream), "clearing device memory");
  check_cuda(cudaStreamSynchronize(stream), kDecoding);
  return {found[0], found[1]};
}

}  // namespace weir
