// Tests docs/embedding.md: its programs equal those of examples/embed, which build with only a compiler and print the
// values of the file.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "format/base/text.h"
#include "tests/tools/support/embedded_example.h"

namespace weir::embedding_test {
namespace {

const std::string kExample = WEIR_SOURCE_DIR "/examples/embed";

TEST(Embedding, TheDocumentShowsTheFilesThatAreCompiled) {
  const std::string document = read_file(WEIR_SOURCE_DIR "/docs/embedding.md");
  for (const auto& [name, language] :
       {std::pair{"CMakeLists.txt", "cmake"}, {"sample_host.cpp", "cpp"}, {"sample_device.cu", "cpp"}}) {
    const std::string block = cat("```", language, "\n", read_file(cat(kExample, "/", name)), "```\n");
    EXPECT_NE(document.find(block), std::string::npos) << name << " differs";
  }
}

TEST(Embedding, AHostProgramBuildsAloneAndPrintsTheValues) {
  const EmbeddedExample embedded({"-DWEIR_CUDA=OFF"});
  // Voxel i has its centre at i + 0.5; positions outside are clamped.
  const CommandResult sampled =
      embedded.run("sample_host", {embedded.file(), "8", "5.5", "3.25", "0.5", "0.5", "0.5", "15.5", "99", "-1"});
  EXPECT_EQ(sampled.exit_code, 0) << sampled.err;
  EXPECT_EQ(sampled.out, "1207.5\n0\n315\n");
  const CommandResult refused = embedded.run("sample_host", {embedded.file() + ".none"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(refused.err, embedded.file() + ".none: cannot open: No such file or directory\n");
}

TEST(Embedding, ADeviceProgramBuildsAloneAndPrintsTheValues) {
  const std::string nvcc = WEIR_NVCC;
  if (nvcc.empty()) GTEST_SKIP() << "no nvcc";
  const EmbeddedExample embedded({"-DWEIR_CUDA=ON", "-DCMAKE_CUDA_COMPILER=" + nvcc, "-DCMAKE_CUDA_ARCHITECTURES=90"});
  const CommandResult sampled =
      embedded.run("sample_device", {embedded.file(), "8", "5.5", "3.25", "15.5", "99", "-1"});
  if (sampled.exit_code == 2) {  // the program ran on a machine without a device
    EXPECT_EQ(sampled.err.rfind("no CUDA device: ", 0), 0U) << sampled.err;
    return;
  }
  EXPECT_EQ(sampled.exit_code, 0) << sampled.err;
  EXPECT_EQ(sampled.out.substr(sampled.out.find('\n') + 1), "1207.5\n315\n");
}

}  // namespace
}  // namespace weir::embedding_test
