#include <algorithm>
#include <cstdint>
#include <string_view>

#include "gpu/cuda/encode/lattice_code_steps.h"
#include "gpu/cuda/encode/launch.h"
#include "gpu/cuda/encode/near_steps.h"
#include "gpu/cuda/encode/record_steps.h"
#include "gpu/cuda/encode/stream_steps.h"
#include "gpu/cuda/encode/summary_steps.h"
#include "gpu/cuda/runtime/launch_kernel.cuh"

namespace weir {
namespace {

using namespace encode_detail;

constexpr std::string_view kSurveying = "surveying blocks on the device";
constexpr std::string_view kEncoding = "encoding blocks on the device";
constexpr unsigned kWarps = 8;  // per group
constexpr unsigned kThreads = kWarps * kLanes;
constexpr unsigned kSurveyGroups = 4;  // least number per multiprocessor
constexpr unsigned kLatticeWarps = 4;
constexpr unsigned kLatticeGroups = 7;
constexpr unsigned kCodeGroups = 5;
constexpr unsigned kWordThreads = 128;
constexpr unsigned kStatisticsWarps = 4;
constexpr std::uint32_t kMostGroups = 132 * 16;  // fill every device; each warp takes several blocks

// Called by all threads of a group.
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

__global__ void __launch_bounds__(kLatticeWarps* kLanes, kLatticeGroups) survey_all_near_rungs(NearCall call) {
  __shared__ CostTables tables;
  __shared__ LatticeStage stages[kLatticeWarps];
  load_tables(tables, call.tables);
  const unsigned warp = threadIdx.x / kLanes;
  const std::uint32_t count = call.box.count();
  for (std::uint32_t b = blockIdx.x * kLatticeWarps + warp; b < count; b += gridDim.x * kLatticeWarps) {
    survey_near_rungs(DeviceWarp{}, call, tables, b, stages[warp]);
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

__global__ void __launch_bounds__(kLatticeWarps* kLanes, kLatticeGroups) code_lattice_blocks(EncodeCall call) {
  __shared__ CostTables tables;
  __shared__ LatticeStage stages[kLatticeWarps];
  load_tables(tables, call.tables);
  const unsigned warp = threadIdx.x / kLanes;
  for (std::uint32_t i = blockIdx.x * kLatticeWarps + warp; i < call.count; i += gridDim.x * kLatticeWarps) {
    if (call.asks[i].kind != StreamAskKind::transform) {
      code_lattice_block(DeviceWarp{}, call, tables, i, stages[warp]);
    }
  }
}

__global__ void __launch_bounds__(kWordThreads) put_all_words(EncodeCall call) {
  __shared__ TransformCodes codes;
  load_tables(codes, &call.codes->transform);
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

__global__ void __launch_bounds__(kThreads) summarize_blocks(SummaryCall call) {
  __shared__ DigestTables tables;
  __shared__ SummaryStage stages[kWarps];
  load_tables(tables, call.tables);
  const unsigned warp = threadIdx.x / kLanes;
  const std::uint32_t count = call.box.count();
  for (std::uint32_t b = blockIdx.x * kWarps + warp; b < count; b += gridDim.x * kWarps) {
    summarize_block(DeviceWarp{}, call, tables, b, stages[warp]);
    __syncwarp();
  }
}

__global__ void __launch_bounds__(kThreads) copy_blocks(ValuesCall call) {
  __shared__ float stages[kWarps][kStageWords];
  const unsigned warp = threadIdx.x / kLanes;
  for (std::uint32_t i = blockIdx.x * kWarps + warp; i < call.count; i += gridDim.x * kWarps) {
    copy_block(DeviceWarp{}, call, i, stages[warp]);
  }
}

__global__ void __launch_bounds__(kThreads) count_values(CountCall call) {
  __shared__ std::uint32_t counts[kMostCountedBins];
  for (unsigned i = threadIdx.x; i < call.bins; i += blockDim.x) counts[i] = 0;
  __syncthreads();
  const std::uint64_t step = std::uint64_t{gridDim.x} * blockDim.x;
  for (std::uint64_t first = std::uint64_t{blockIdx.x} * blockDim.x; first < call.count; first += step) {
    const std::uint64_t i = first + threadIdx.x;
    const std::uint32_t bin = i < call.count ? bin_of_value(call, call.values[i]) : kMostCountedBins;
    // In empty space all lanes have the same bin.
    if (__all_sync(~0U, bin == __shfl_sync(~0U, bin, 0))) {
      if (threadIdx.x % kLanes == 0 && bin < kMostCountedBins) atomicAdd(&counts[bin], kLanes);
    } else if (bin < kMostCountedBins) {
      atomicAdd(&counts[bin], 1U);
    }
  }
  __syncthreads();
  for (unsigned i = threadIdx.x; i < call.bins; i += blockDim.x) {
    if (counts[i] != 0) atomicAdd(&call.counts[i], static_cast<unsigned long long>(counts[i]));
  }
}

__global__ void __launch_bounds__(kStatisticsWarps* kLanes) add_all_statistics(RecordCall call) {
  __shared__ StatisticsTile tiles[kStatisticsWarps];
  const unsigned warp = threadIdx.x / kLanes;
  const std::uint32_t step = gridDim.x * kStatisticsWarps * kLanes;
  for (std::uint32_t first = (blockIdx.x * kStatisticsWarps + warp) * kLanes; first < call.count; first += step) {
    add_statistics(DeviceWarp{}, call, first, tiles[warp]);
  }
}

__global__ void __launch_bounds__(kThreads) make_records(RecordCall call) {
  __shared__ DigestTables tables;
  __shared__ RecordStage stages[kWarps];
  load_tables(tables, call.tables);
  const unsigned warp = threadIdx.x / kLanes;
  for (std::uint32_t i = blockIdx.x * kWarps + warp; i < call.count; i += gridDim.x * kWarps) {
    make_record(DeviceWarp{}, call, tables, i, stages[warp]);
    __syncwarp();
  }
}

unsigned groups_for(std::uint32_t count, unsigned each) {
  return std::clamp((count + each - 1) / each, 1U, kMostGroups);
}

}  // namespace

void launch_survey(const SurveyCall& call, cudaStream_t stream) {
  launch_kernel(kSurveying, {groups_for(call.box.count(), kWarps), kThreads, stream}, survey_blocks, call);
}

void launch_near_survey(const NearCall& call, cudaStream_t stream) {
  launch_kernel(kSurveying, {groups_for(call.box.count(), kLatticeWarps), kLatticeWarps * kLanes, stream},
                survey_all_near_rungs, call);
}

void launch_encode(const EncodeCall& call, cudaStream_t stream) {
  const unsigned groups = groups_for(call.count, kWarps);
  launch_kernel(kEncoding, {groups, kThreads, stream}, code_blocks, call);
  if (call.on_lattices) {
    launch_kernel(kEncoding, {groups_for(call.count, kLatticeWarps), kLatticeWarps * kLanes, stream},
                  code_lattice_blocks, call);
  }
  launch_kernel(kEncoding, {groups_for(call.count, kWordThreads), kWordThreads, stream}, put_all_words, call);
  launch_kernel(kEncoding, {groups, kThreads, stream}, put_all_bytes, call);
}

void launch_records(const RecordCall& call, cudaStream_t stream) {
  constexpr unsigned kAsks = kStatisticsWarps * kLanes;
  launch_kernel(kEncoding, {groups_for(call.count, kAsks), kAsks, stream}, add_all_statistics, call);
  launch_kernel(kEncoding, {groups_for(call.count, kWarps), kThreads, stream}, make_records, call);
}

void launch_summaries(const SummaryCall& call, cudaStream_t stream) {
  launch_kernel(kSurveying, {groups_for(call.box.count(), kWarps), kThreads, stream}, summarize_blocks, call);
}

void launch_values(const ValuesCall& call, cudaStream_t stream) {
  launch_kernel("copying blocks from the device", {groups_for(call.count, kWarps), kThreads, stream}, copy_blocks,
                call);
}

void launch_count(const CountCall& call, cudaStream_t stream) {
  launch_kernel("counting values on the device", {kMostGroups, kThreads, stream}, count_values, call);
}

}  // namespace weir
