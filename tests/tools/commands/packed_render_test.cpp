// Tests weir render and play on packed files whose decoded voxels are several times as large as --memory.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "format/nanovdb/nvdb_file.h"
#include "tests/support/run_command.h"
#include "tests/support/sanitized.h"

namespace weir::packed_render_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
constexpr std::uint64_t kMemory = 16 * kMiB;
constexpr std::uint64_t kDecoded = 32ULL * 32 * 32 * 2144;  // 67 MiB

class PackedRender : public testing::Test {
 protected:
  PackedRender() {
    const std::string input = directory_ / "t_256x256x256_float32.raw";
    EXPECT_EQ(run_weir({"sample", "turbulence", "-o", input}).exit_code, 0);
    const CommandResult converted = run_weir({"convert", input, "-o", volume_, "--encoding", "packed", "--rate", "20"});
    EXPECT_EQ(converted.exit_code, 0) << converted.err;
  }

  CommandResult render(const std::string& image, const std::vector<std::string>& more) const {
    // A slow machine would otherwise write lines of progress between the messages that the tests compare.
    std::vector<std::string> all{"render", volume_,  "-o",        image, "--size",      "160x120",    "--spp",
                                 "2",      "--json", "--backend", "cpu", "--overwrite", "--progress", "never"};
    all.insert(all.end(), more.begin(), more.end());
    return run_weir(all);
  }

  TemporaryDirectory directory_;
  std::string volume_ = directory_ / "packed.nvdb";
};

TEST_F(PackedRender, DecodedVoxelsFourTimesTheMemory_GiveTheSamePictureInIt) {
  ASSERT_GE(kDecoded, 4 * kMemory);
  for (const std::string mode : {"path", "dvr", "iso", "mip"}) {
    const CommandResult decoded = render(directory_ / "decoded.png", {"--mode", mode});
    ASSERT_EQ(decoded.exit_code, 0) << decoded.err;
    const nlohmann::json all = nlohmann::json::parse(decoded.out);
    EXPECT_EQ(all["load"]["way"], "decoded");
    EXPECT_GT(all["load"]["memory_bytes"].get<std::uint64_t>(), kDecoded);
    EXPECT_EQ(all["cache"], nullptr);

    const CommandResult cached = render(directory_ / "cached.png", {"--mode", mode, "--memory", "16MiB"});
    ASSERT_EQ(cached.exit_code, 0) << cached.err;
    EXPECT_EQ(cached.err, "");
    const nlohmann::json few = nlohmann::json::parse(cached.out);
    EXPECT_EQ(few["load"]["way"], "cached");
    EXPECT_EQ(few["load"]["note"], "all blocks decoded take 67.0 MiB, so they go through a cache, more slowly");
    EXPECT_LE(few["load"]["memory_bytes"].get<std::uint64_t>(), kMemory);
    EXPECT_GT(few["cache"]["lookups"].get<std::uint64_t>(), few["cache"]["decoded"].get<std::uint64_t>());
    EXPECT_GT(few["cache"]["evicted"].get<std::uint64_t>(), 0U) << mode;
    EXPECT_TRUE(read_file(directory_ / "cached.png") == read_file(directory_ / "decoded.png")) << mode;
    if (!kSanitized) {
      EXPECT_GT(decoded.peak_rss_bytes, kDecoded) << mode;
      EXPECT_LT(cached.peak_rss_bytes, kDecoded - kMemory) << mode << ": code, picture, pages of the file and 16 MiB";
    }
  }
}

TEST_F(PackedRender, Series_SharesTheMemoryBetweenTwoSteps) {
  const std::string steps = directory_ / "steps";
  std::filesystem::create_directory(steps);
  for (const std::string step : {"0", "1", "2"}) std::filesystem::copy_file(volume_, steps + "/s_" + step + ".nvdb");
  const auto play = [&](const std::string& memory) {
    const CommandResult result = run_weir({"play", steps + "/s_*.nvdb", "-o", directory_ / memory, "--size", "80x60",
                                           "--mode", "dvr", "--backend", "cpu", "--json", "--memory", memory});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out)["load"]["way"].get<std::string>();
  };
  EXPECT_EQ(play("140MiB"), "decoded");
  EXPECT_EQ(play("96MiB"), "cached") << "48 MiB for each of the two that are held";
  EXPECT_TRUE(read_file(directory_ / "96MiB/frame_00002.png") == read_file(directory_ / "140MiB/frame_00002.png"));
}

TEST_F(PackedRender, TooLittleMemory_IsRefusedWithWhatItTakes) {
  const CommandResult result = render(directory_ / "a.png", {"--memory", "512KiB"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err,
            "weir: " + volume_ +
                ": --memory 512.0 KiB is too small to render this grid, which takes 688.0 KiB at least; give "
                "--memory 1MiB or more\n");
  EXPECT_FALSE(std::filesystem::exists(directory_ / "a.png"));
}

TEST_F(PackedRender, DamagedStream_EndsWithTheErrorOfTheDecodedFile) {
  std::uint64_t at = 0;
  {
    const NvdbFile file(volume_);
    at = static_cast<std::uint64_t>(file.grid().block_at({128, 128, 128}).stream.data - file.bytes().data());
  }
  std::string bytes = read_file(volume_);
  bytes[at] = static_cast<char>(bytes[at] | 3);  // raw, of another length
  write_file(volume_, bytes);
  const CommandResult decoded = render(directory_ / "a.png", {"--mode", "dvr"});
  EXPECT_EQ(decoded.exit_code, 3);
  EXPECT_NE(decoded.err.find("is damaged"), std::string::npos) << decoded.err;
  const CommandResult cached = render(directory_ / "a.png", {"--mode", "dvr", "--memory", "16MiB"});
  EXPECT_EQ(cached.exit_code, 3);
  EXPECT_EQ(cached.err, decoded.err);
}

}  // namespace
}  // namespace weir::packed_render_test
