// Tests what weir convert --backend refuses, and that the choice leaves no trace in the record.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/run_command.h"

namespace weir::convert_backend_test {
namespace {

class ConvertBackend : public testing::Test {
 protected:
  ConvertBackend() {
    const auto made = run_weir({"sample", "turbulence", "--dims", "40,40,40", "-o", input_});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }
  CommandResult convert(const std::vector<std::string>& options) const {
    std::vector<std::string> words{"convert", input_, "-o", directory_ / "t.nvdb", "--overwrite"};
    words.insert(words.end(), options.begin(), options.end());
    return run_weir(words);
  }

  TemporaryDirectory directory_;
  std::string input_ = directory_ / "t_40x40x40_float32.raw";
};

TEST_F(ConvertBackend, CudaForAnotherEncoding_ExitsWith2) {
  const auto refused = convert({"--encoding", "float", "--backend", "cuda"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err,
            "weir: --backend cuda converts to --encoding packed alone; give that, or use --backend auto\n");
}

#ifndef WEIR_HAVE_CUDA
TEST_F(ConvertBackend, CudaInABuildWithoutIt_ExitsWith2) {
  const auto refused = convert({"--encoding", "packed", "--backend", "cuda"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err, "weir: --backend cuda: this build has no CUDA encoder; use --backend cpu or auto\n");
}
#endif

TEST_F(ConvertBackend, TheChoiceIsNotRecorded) {
  const auto made = convert({"--encoding", "packed", "--backend", "cpu", "--json"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.out.find("\"encoding\""), std::string::npos) << made.out;
  EXPECT_EQ(made.out.find("backend"), std::string::npos) << made.out;
}

}  // namespace
}  // namespace weir::convert_backend_test
