// In place of the kernels that survey and encode packed blocks: their steps, a block after the other.
#include "gpu/cuda/encode/launch.h"
#include "gpu/cuda/encode/stream_steps.h"
#include "gpu/cuda/runtime/check.h"

namespace weir {

void launch_survey(const SurveyCall& call, cudaStream_t /*stream*/) {
  check_cuda(cudaStreamSynchronize(nullptr), "surveying blocks on the device");  // a launch that a test can make fail
  encode_detail::BlockStage stage;
  for (std::uint32_t b = 0; b < call.box.count(); ++b) {
    survey_block(encode_detail::HostWarp{}, call, *call.tables, b, stage);
  }
}

void launch_encode(const EncodeCall& call, cudaStream_t /*stream*/) {
  check_cuda(cudaStreamSynchronize(nullptr), "encoding blocks on the device");
  encode_detail::CodeStage stage;
  for (std::uint32_t i = 0; i < call.count; ++i) {
    code_block(encode_detail::HostWarp{}, call, *call.tables, i, stage);
    put_words(call, *call.codes, i);
    put_bytes(encode_detail::HostWarp{}, call, i);
  }
}

}  // namespace weir
