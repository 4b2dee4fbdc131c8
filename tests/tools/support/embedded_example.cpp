#include "tests/tools/support/embedded_example.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "format/base/text.h"

namespace weir {
namespace {

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

}  // namespace

EmbeddedExample::EmbeddedExample(const std::vector<std::string>& options) {
  write_file(directory_ / "a_16x16x16_float32.raw", linear_volume());
  const CommandResult converted =
      run_weir({"convert", directory_ / "a_16x16x16_float32.raw", "-o", file(), "--lossless", "--log-level", "off"});
  EXPECT_EQ(converted.exit_code, 0) << converted.err;

  CommandOptions patient;
  patient.timeout = std::chrono::minutes(10);
  std::vector<std::string> configure{WEIR_CMAKE,
                                     "-S",
                                     WEIR_SOURCE_DIR "/examples/embed",
                                     "-B",
                                     directory_ / "build",
                                     "-G",
                                     WEIR_GENERATOR,
                                     "-DCMAKE_BUILD_TYPE=Release",
                                     "-DCMAKE_UNITY_BUILD=ON",
                                     "-DCMAKE_CXX_COMPILER=" WEIR_CXX,
                                     "-DCMAKE_CXX_COMPILER_LAUNCHER=" WEIR_LAUNCHER};
  configure.insert(configure.end(), options.begin(), options.end());
  const CommandResult configured = run_command(configure, patient);
  EXPECT_EQ(configured.exit_code, 0) << configured.out << configured.err;
  configuration_ = configured.out;
  for (const char* library : {"TBB", "ZLIB", "PNG", "HDF5", "spdlog", "json"}) {
    EXPECT_EQ(configured.out.find(cat("Found ", library)), std::string::npos) << configured.out;
  }
  const CommandResult built = run_command({WEIR_CMAKE, "--build", directory_ / "build"}, patient);
  EXPECT_EQ(built.exit_code, 0) << built.out << built.err;
}

CommandResult EmbeddedExample::run(const std::string& program, std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), cat(directory_ / "build", "/", program));
  return run_command(arguments);
}

bool EmbeddedExample::has(const std::string& program) const {
  return std::filesystem::exists(cat(directory_ / "build", "/", program));
}

}  // namespace weir
