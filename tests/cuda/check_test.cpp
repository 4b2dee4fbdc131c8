#include "gpu/cuda/runtime/check.h"

#include <gtest/gtest.h>

#include <string>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/cuda/support/refusal.h"

namespace weir::check_test {
namespace {

using test::refusal;

TEST(CheckCuda, SaysWhatFailedAndWhatCudaCallsIt) {
  check_cuda(cudaSuccess, "nothing");
  EXPECT_EQ(refusal(ErrorKind::io, [] { check_cuda(cudaErrorMemoryAllocation, "allocating 4 GiB"); }),
            "allocating 4 GiB: cudaErrorMemoryAllocation, out of memory");
}

TEST(CheckCuda, NamesTheRemedyWhereThereIsNoDevice) {
  const int devices = device_count();
  if (devices > 0) {
    EXPECT_EQ(refusal(ErrorKind::usage, [&] { use_device(devices); }),
              cat("there is no CUDA device ", devices, ", the last is ", devices - 1));
    return;
  }
  const std::string message = refusal(ErrorKind::usage, [] { use_device(0); });
  EXPECT_EQ(message.rfind("no CUDA device: ", 0), 0U) << message;
  EXPECT_EQ(message.substr(message.size() - 19), "; use --backend cpu") << message;
}

}  // namespace
}  // namespace weir::check_test
