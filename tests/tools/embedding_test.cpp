// docs/embedding.md is true: its programs are those of examples/embed, which build with a compiler alone and print
// what the file holds.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "format/text.h"
#include "tests/tools/run_command.h"

namespace weir {
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

// x + 20 y + 400 z: linear, so that every trilinear value is exact.
std::string linear_volume() {
  std::string bytes;
  for (int z = 0; z < 16; ++z) {
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        const auto value = static_cast<float>(x + 20 * y + 400 * z);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
      }
    }
  }
  return bytes;
}

/// The example built in a directory of its own, and a file to sample.
class Embedded {
 public:
  /// `options` of the example's configuration.
  explicit Embedded(std::vector<std::string> options) {
    write_file(directory_ / "a_16x16x16_float32.raw", linear_volume());
    const CommandResult converted =
        run_weir({"convert", directory_ / "a_16x16x16_float32.raw", "-o", file(), "--lossless", "--log-level", "off"});
    EXPECT_EQ(converted.exit_code, 0) << converted.err;

    CommandOptions patient;
    patient.timeout = std::chrono::minutes(10);
    std::vector<std::string> configure{WEIR_CMAKE,
                                       "-S",
                                       kExample,
                                       "-B",
                                       directory_ / "build",
                                       "-G",
                                       WEIR_GENERATOR,
                                       "-DCMAKE_BUILD_TYPE=Release",
                                       "-DCMAKE_CXX_COMPILER=" WEIR_CXX,
                                       "-DCMAKE_CXX_COMPILER_LAUNCHER=" WEIR_LAUNCHER};
    configure.insert(configure.end(), options.begin(), options.end());
    const CommandResult configured = run_command(configure, patient);
    EXPECT_EQ(configured.exit_code, 0) << configured.out << configured.err;
    for (const char* library : {"TBB", "ZLIB", "PNG", "HDF5", "spdlog", "json"}) {
      EXPECT_EQ(configured.out.find(cat("Found ", library)), std::string::npos) << configured.out;
    }
    const CommandResult built = run_command({WEIR_CMAKE, "--build", directory_ / "build"}, patient);
    EXPECT_EQ(built.exit_code, 0) << built.out << built.err;
  }

  std::string file() const { return directory_ / "a.nvdb"; }
  CommandResult run(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), cat(directory_ / "build", "/", program));
    return run_command(arguments);
  }

 private:
  const TemporaryDirectory directory_;
};

TEST(Embedding, AHostProgramBuildsAloneAndPrintsTheValues) {
  const Embedded embedded({"-DWEIR_CUDA=OFF"});
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
  const Embedded embedded({"-DWEIR_CUDA=ON", "-DCMAKE_CUDA_COMPILER=" + nvcc, "-DCMAKE_CUDA_ARCHITECTURES=90"});
  const CommandResult sampled =
      embedded.run("sample_device", {embedded.file(), "8", "5.5", "3.25", "15.5", "99", "-1"});
  if (sampled.exit_code == 2) {  // it ran, on a machine without a device
    EXPECT_EQ(sampled.err.rfind("no CUDA device: ", 0), 0U) << sampled.err;
    return;
  }
  EXPECT_EQ(sampled.exit_code, 0) << sampled.err;
  EXPECT_EQ(sampled.out.substr(sampled.out.find('\n') + 1), "1207.5\n315\n");
}

}  // namespace
}  // namespace weir
