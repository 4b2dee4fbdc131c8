// Tests the memory that a picture takes beside its volume, as docs/limits.md states it: no picture is held twice.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "format/base/text.h"
#include "tests/support/sanitized.h"
#include "tests/tools/support/converted_volume.h"

namespace weir::picture_memory_test {
namespace {

constexpr std::uint64_t kPixels = 4096 * 2048;
constexpr std::uint64_t kProgram = 48 << 20U;  // code, volume and what the test's own process had

class PictureMemory : public ConvertedVolume {
 protected:
  /// Returns an upper bound of the bytes per pixel that weir took.
  static std::uint64_t taken(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(),
                     {"--size", "4096x2048", "--mode", "mip", "--spp", "1", "--backend", "cpu", "--quiet"});
    const CommandResult result = run_weir(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return (result.peak_rss_bytes - std::min(result.peak_rss_bytes, kProgram)) / kPixels;
  }
};

TEST_F(PictureMemory, OfAPictureWithItsColourBar_IsThatOfBothAlone) {
  if (kSanitized) GTEST_SKIP() << "memory of a sanitised build is another";
  EXPECT_LE(taken({"render", volume_, "-o", directory_ / "a.png", "--colorbar"}), 27U);
}

TEST_F(PictureMemory, OfFrames_IsThatOfTheOneDrawnAndTheOneWritten) {
  if (kSanitized) GTEST_SKIP() << "memory of a sanitised build is another";
  std::vector<std::string> arguments{"play", "-o", directory_ / "frames"};
  for (const char* name : {"s_1.nvdb", "s_2.nvdb", "s_3.nvdb"}) {
    std::filesystem::copy_file(volume_, directory_ / name);
    arguments.push_back(directory_ / name);
  }
  EXPECT_LE(taken(arguments), 31U);
}

}  // namespace
}  // namespace weir::picture_memory_test
