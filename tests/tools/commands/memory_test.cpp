// Tests the memory ceiling of the whole process from outside: a volume eight times as large as --memory, read from the
// page cache and past it. The kernel's figure counts.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"

namespace weir::memory_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

TEST(Memory, ATwoGibibyteVolumeStaysUnderTheCeiling) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const TemporaryDirectory directory;
  const std::string input = directory / "cloud_820x820x800_float32.raw";
  CommandOptions patient;
  patient.timeout = std::chrono::minutes(10);
  const CommandResult sample = run_weir({"sample", "cloud", "-o", input, "--memory", "128MiB"}, patient);
  ASSERT_EQ(sample.exit_code, 0) << sample.err;
  EXPECT_LT(sample.peak_rss_bytes, 128 * kMiB);
  const std::uint64_t bytes = 820ULL * 820 * 800 * 4;
  ASSERT_GT(bytes, 2048 * kMiB);
  ASSERT_EQ(std::filesystem::file_size(input), bytes);

  std::string digest;
  for (const std::string direct_io : {"on", "auto"}) {
    const CommandResult result = run_weir({"convert", input, "-o", directory / "out.nvdb", "--overwrite", "--memory",
                                           "256MiB", "--direct-io", direct_io, "--json"},
                                          patient);
    if (result.exit_code == 2 && direct_io == "on") continue;  // no direct I/O on this file system
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json sidecar = nlohmann::json::parse(result.out);
    EXPECT_LT(result.peak_rss_bytes, 256 * kMiB) << direct_io;
    EXPECT_LT(sidecar["timing"]["peak_rss_bytes"].get<std::uint64_t>(), 256 * kMiB) << direct_io;
    EXPECT_GT(sidecar["timing"]["peak_rss_bytes"].get<std::uint64_t>(), 4 * kMiB) << direct_io;
    EXPECT_EQ(std::filesystem::file_size(directory / "out.nvdb"), bytes / 8);
    const std::string found = sidecar["file"]["digest"];
    EXPECT_TRUE(digest.empty() || digest == found) << digest << " with direct I/O, " << found << " without";
    digest = found;
  }
  const CommandResult compare =
      run_weir({"compare", input, directory / "out.nvdb", "--memory", "256MiB", "--json"}, patient);
  ASSERT_EQ(compare.exit_code, 0) << compare.err;
  EXPECT_LT(compare.peak_rss_bytes, 256 * kMiB);
  const nlohmann::json measured = nlohmann::json::parse(compare.out);
  const nlohmann::json certified = nlohmann::json::parse(read_file(directory / "out.nvdb.json"))["error"];
  EXPECT_NEAR(measured["mse"].get<double>() / certified["mse"].get<double>(), 1.0, 1e-6);
  EXPECT_EQ(measured["max_abs"].get<double>(), certified["max_abs"].get<double>());
}

// Uses the least --memory and one thread, repeatedly, because the memory layout of the process differs each time.
TEST(Memory, SmallVolumesConvertInTheLeastCeiling) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const TemporaryDirectory directory;
  for (const std::string edge : {"64", "160"}) {
    const std::string input = directory / ("v_" + edge + "x" + edge + "x" + edge + "_float32.raw");
    ASSERT_EQ(run_weir({"sample", "cloud", "-o", input}).exit_code, 0);
    for (int round = 0; round < 5; ++round) {
      for (const std::string encoding : {"auto", "float"}) {
        const CommandResult result = run_weir({"convert", input, "-o", directory / "out.nvdb", "--overwrite", "--rate",
                                               "2", "--memory", "64MiB", "--threads", "1", "--encoding", encoding});
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_LT(result.peak_rss_bytes, 64 * kMiB);
      }
    }
  }
}

// The file is much larger than the ceiling and is mapped to certify the gradient.
TEST(Memory, TheGradientIsCertifiedInTheLeastCeiling) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const TemporaryDirectory directory;
  const std::string input = directory / "t_400x400x200_float32.raw";
  ASSERT_EQ(run_weir({"sample", "turbulence", "-o", input}).exit_code, 0);
  const CommandResult result = run_weir({"convert", input, "-o", directory / "out.nvdb", "--rate", "2", "--memory",
                                         "64MiB", "--threads", "2", "--encoding", "float", "--certify", "gradient"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_LT(result.peak_rss_bytes, 64 * kMiB);
}

// A volume of one layer has one layer of macrocells, here of 7.6 MiB; no more are held and counted.
TEST(Memory, AFlatVolumeConvertsInTheLeastCeiling) {
  if (kSanitized) GTEST_SKIP() << kSanitizedSkip;
  const TemporaryDirectory directory;
  const std::string input = directory / "flat_16000x16000x1_uint8.raw";
  {
    std::ofstream file(input, std::ios::binary);
    for (const std::streamoff row : {0, 7001, 15999}) {
      file.seekp(row * 16000);
      file << std::string(16000, static_cast<char>(row % 100 + 1));
    }
  }
  const CommandResult result = run_weir({"convert", input, "-o", directory / "flat.nvdb", "--rate", "20", "--at-most",
                                         "--memory", "64MiB", "--threads", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_LT(result.peak_rss_bytes, 64 * kMiB);
}

}  // namespace
}  // namespace weir::memory_test
