// Replaces the kernels that survey and encode packed blocks: runs their steps on the host, one block after the other.
#include "gpu/cuda/encode/lattice_code_steps.h"
#include "gpu/cuda/encode/launch.h"
#include "gpu/cuda/encode/near_steps.h"
#include "gpu/cuda/encode/record_steps.h"
#include "gpu/cuda/encode/stream_steps.h"
#include "gpu/cuda/encode/summary_steps.h"
#include "gpu/cuda/runtime/check.h"
#include "tests/fake_coder/support.h"

namespace weir {

void launch_survey(const SurveyCall& call, cudaStream_t /*stream*/) {
  check_cuda(cudaStreamSynchronize(nullptr), "surveying blocks on the device");  // a launch that a test can make fail
  encode_detail::BlockStage stage;
  for (std::uint32_t b = 0; b < call.box.count(); ++b) {
    survey_block(encode_detail::HostWarp{}, call, *call.tables, b, stage);
  }
}

void launch_near_survey(const NearCall& call, cudaStream_t /*stream*/) {
  check_cuda(cudaStreamSynchronize(nullptr), "surveying blocks on the device");
  encode_detail::LatticeStage stage;
  for (std::uint32_t b = 0; b < call.box.count(); ++b) {
    survey_near_rungs(encode_detail::HostWarp{}, call, *call.tables, b, stage);
  }
}

void launch_encode(const EncodeCall& call, cudaStream_t /*stream*/) {
  check_cuda(cudaStreamSynchronize(nullptr), "encoding blocks on the device");
  encode_detail::CodeStage stage;
  encode_detail::LatticeStage lattice_stage;
  for (std::uint32_t i = 0; i < call.count; ++i) {
    code_block(encode_detail::HostWarp{}, call, *call.tables, i, stage);
    if (call.asks[i].kind != StreamAskKind::transform) {
      code_lattice_block(encode_detail::HostWarp{}, call, *call.tables, i, lattice_stage);
    }
    put_words(call, call.codes->transform, i);
    put_bytes(encode_detail::HostWarp{}, call, i);
  }
}

void launch_records(const RecordCall& call, cudaStream_t /*stream*/) {
  encode_detail::StatisticsTile tile;
  encode_detail::RecordStage stage;
  for (std::uint32_t i = 0; i < call.count; i += encode_detail::kLanes) {
    add_statistics(encode_detail::HostWarp{}, call, i, tile);
  }
  for (std::uint32_t i = 0; i < call.count; ++i) {
    make_record(encode_detail::HostWarp{}, call, *call.tables, i, stage);
  }
}

void launch_summaries(const SummaryCall& call, cudaStream_t /*stream*/) {
  encode_detail::SummaryStage stage;
  for (std::uint32_t b = 0; b < call.box.count(); ++b) {
    summarize_block(encode_detail::HostWarp{}, call, *call.tables, b, stage);
  }
}

void launch_values(const ValuesCall& call, cudaStream_t /*stream*/) {
  float stage[kStageWords];
  fake_coder_test::values_copied() += call.count;
  for (std::uint32_t i = 0; i < call.count; ++i) copy_block(encode_detail::HostWarp{}, call, i, stage);
}

void launch_count(const CountCall& call, cudaStream_t /*stream*/) {
  check_cuda(cudaStreamSynchronize(nullptr), "counting values on the device");
  for (std::uint64_t i = 0; i < call.count; ++i) {
    const std::uint32_t bin = bin_of_value(call, call.values[i]);
    if (bin < call.bins) ++call.counts[bin];
  }
}

}  // namespace weir
