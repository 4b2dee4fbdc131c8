#include <algorithm>
#include <cstdint>

#include "gpu/cuda/encode/launch.h"
#include "gpu/cuda/encode/stream_steps.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {
namespace {

using namespace encode_detail;

constexpr unsigned kWarps = 8;  // of a group
constexpr unsigned kThreads = kWarps * kLanes;
constexpr unsigned kSurveyGroups = 4;  // a multiprocessor, at least
constexpr unsigned kCodeGroups = 5;
constexpr unsigned kWordThreads = 128;
constexpr std::uint32_t kMostGroups = 132 * 16;  // so many fill every device; each of their warps takes several blocks

// All of a group's threads.
template <class T>
__device__ void load_tables(T& to, const T* from) {
  static_assert(sizeof(T) % sizeof(Quad) == 0);
  for (unsigned i = threadIdx.x; i < sizeof(T) / sizeof(Quad); i += blockDim.x) {
    reinterpret_cast<Quad*>(&to)[i] = reinterpret_cast<const Quad*>(from)[i];
  }
  __syncthreads();
}

__global__ void __launch_bounds__(kThreads, kSurveyGroups) survey_blocks(SurveyCall call) {
  __shared__ CostTables tables;
  __shared__ BlockStage stages[kWarps];
  load_tables(tables, call.tables);
  const unsigned warp = threadIdx.x / kLanes;
  const std::uint32_t count = call.box.count();
  for (std::uint32_t b = blockIdx.x * kWarps + warp; b < count; b += gridDim.x * kWarps) {
    survey_block(DeviceWarp{}, call, tables, b, stages[warp]);
  }
}

__global__ void __launch_bounds__(kThreads, kCodeGroups) code_blocks(EncodeCall call) {
  __shared__ CostTables tables;
  __shared__ CodeStage stages[kWarps];
  load_tables(tables, call.tables);
  const unsigned warp = threadIdx.x / kLanes;
  for (std::uint32_t i = blockIdx.x * kWarps + warp; i < call.count; i += gridDim.x * kWarps) {
    code_block(DeviceWarp{}, call, tables, i, stages[warp]);
  }
}

__global__ void __launch_bounds__(kWordThreads) put_all_words(EncodeCall call) {
  __shared__ CodeTables codes;
  load_tables(codes, call.codes);
  for (std::uint32_t i = blockIdx.x * kWordThreads + threadIdx.x; i < call.count; i += gridDim.x * kWordThreads) {
    put_words(call, codes, i);
  }
}

__global__ void __launch_bounds__(kThreads) put_all_bytes(EncodeCall call) {
  const unsigned warp = threadIdx.x / kLanes;
  for (std::uint32_t i = blockIdx.x * kWarps + warp; i < call.count; i += gridDim.x * kWarps) {
    put_bytes(DeviceWarp{}, call, i);
  }
}

unsigned groups_for(std::uint32_t count, unsigned each) {
  return std::clamp((count + each - 1) / each, 1U, kMostGroups);
}

}  // namespace

void launch_survey(const SurveyCall& call, cudaStream_t stream) {
  survey_blocks<<<groups_for(call.box.count(), kWarps), kThreads, 0, stream>>>(call);
  check_cuda(cudaGetLastError(), "surveying blocks on the device");
}

void launch_encode(const EncodeCall& call, cudaStream_t stream) {
  const unsigned groups = groups_for(call.count, kWarps);
  code_blocks<<<groups, kThreads, 0, stream>>>(call);
  put_all_words<<<groups_for(call.count, kWordThreads), kWordThreads, 0, stream>>>(call);
  put_all_bytes<<<groups, kThreads, 0, stream>>>(call);
  check_cuda(cudaGetLastError(), "encoding blocks on the device");
}

}  // namespace weir
