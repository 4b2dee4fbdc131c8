// Conversions of chunked volumes: the notice when chunks are decoded more than once, and that the memory it advises is
// enough.
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "format/base/error.h"
#include "tests/compressor/support/converted.h"

namespace weir::chunked_conversion_test {
namespace {

using test::Converted;
using test::MemoryVolume;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
/// The memory that outputs of earlier conversions, which the test holds in memory, may leave in the process.
constexpr std::uint64_t kMargin = 24 * kMiB;

std::uint64_t advised_mebibytes(const std::string& line) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(line, match, std::regex("([0-9]+)MiB($| decodes)"))) << line;
  return match.empty() ? 0 : std::stoull(match[1]);
}

/// Returns the least --memory with which the volume can be converted, from the advice in the error message.
std::uint64_t least_memory(MemoryVolume& volume) {
  ConversionOptions options;
  options.memory = kMiB;
  options.threads = 2;
  try {
    test::convert(volume, options);
  } catch (const Error& error) {
    return advised_mebibytes(error.what()) * kMiB;
  }
  ADD_FAILURE() << "no error";
  return 0;
}

TEST(ChunkedConversion, SaysWhatDecodingChunksTwiceCosts) {
  MemoryVolume volume({{0, 0, 0}, {256, 256, 64}}, [](const Index3& i) { return static_cast<float>(i.x ^ i.y ^ i.z); });
  volume.info().path = "run.h5";
  ConversionOptions options;
  options.threads = 2;
  options.memory = least_memory(volume) + kMargin;  // blocks of 1 to 10 MiB
  const Converted plain = test::convert(volume, options);
  EXPECT_TRUE(plain.notices.empty());

  volume.set_access({4, {256, 256, 64}, {}});  // 16 MiB
  const Converted tight = test::convert(volume, options);
  ASSERT_EQ(tight.notices.size(), 1U);
  EXPECT_TRUE(std::regex_match(
      tight.notices[0],
      std::regex(R"(run\.h5: its chunks of 256 x 256 x 64 voxels do not fit the blocks of [0-9.]+ MiB that --memory )"
                 R"([0-9.]+ MiB leaves, so that each is decoded [0-9.]+ times in a pass; --memory [0-9]+MiB )"
                 R"(decodes it once)")))
      << tight.notices[0];

  options.memory = advised_mebibytes(tight.notices[0]) * kMiB + kMargin;
  const Converted roomy = test::convert(volume, options);
  EXPECT_TRUE(roomy.notices.empty());
  EXPECT_EQ(roomy.sidecar.file.digest, plain.sidecar.file.digest);
  EXPECT_EQ(tight.sidecar.file.digest, plain.sidecar.file.digest);
}

}  // namespace
}  // namespace weir::chunked_conversion_test
