// Pictures of packed files with decoded blocks that do not fit into memory: drawn by the CPU back end, from a cache.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "gpu/render/backend.h"
#include "gpu/render/cpu_renderer.h"
#include "gpu/render/render_scene.h"
#include "gpu/volume/cached_blocks.h"
#include "tests/support/message_of_error.h"
#include "tests/support/packed_sample.h"
#include "tests/support/temporary_directory.h"

namespace weir::cpu_backend_test {
namespace {

using test::PackedSample;

constexpr std::array kModes{RenderMode::path, RenderMode::dvr, RenderMode::iso, RenderMode::mip};
constexpr std::array kFilters{Filter::nearest, Filter::trilinear, Filter::stochastic};
// The sample's blocks take 882 KiB decoded.
constexpr std::uint64_t kCeiling = 600 << 10U;

RenderOptions options_of(Filter filter) {
  RenderOptions options;
  options.width = 41;
  options.height = 35;
  options.filter = filter;
  return options;
}

Scene scene_of(RenderMode mode) {
  Scene scene;
  scene.mode = mode;
  scene.volume.range = {-100, 800};
  scene.volume.iso = 100;
  return scene;
}

struct CachedPicture {
  Image image;
  CacheCounts counts;
};

// Draws through a cache of `sets` sets of four blocks.
CachedPicture cached_picture(const NvdbGrid& grid, RenderMode mode, Filter filter, int threads, std::uint64_t sets) {
  const MacrocellGrid cells(grid, kMacrocell);
  const RenderSetup setup(volume_info(grid, cells), cells, scene_of(mode), options_of(filter));
  CachedBlocks blocks(grid, sets * BlockCache::kWays * BlockCache::kBlockBytes);
  std::vector<BlockReader> readers(render_threads(threads), BlockReader(blocks));
  std::vector<RenderTask<CachedSampler>> tasks;
  for (BlockReader& reader : readers) tasks.push_back(setup.task(CachedSampler{reader, filter}));
  CpuRenderOptions sampling;
  sampling.samples = 3;
  sampling.threads = threads;
  CachedPicture made{render_cpu(std::span<const RenderTask<CachedSampler>>(tasks), sampling), {}};
  for (const BlockReader& reader : readers) made.counts += reader.counts();
  return made;
}

Image decoded_picture(const NvdbGrid& grid, RenderMode mode, Filter filter) {
  const RenderScene prepared(grid, scene_of(mode), options_of(filter));
  CpuRenderOptions sampling;
  sampling.samples = 3;
  return render_cpu(prepared.task(), sampling);
}

int shown(const Image& image) {
  int count = 0;
  for (const Float3& p : image.pixels) count += p == image.at(0, 0) ? 0 : 1;
  return count;
}

TEST(CachedPicture, EveryModeFilterAndNumberOfThreads_IsThatOfDecodedBlocks) {
  const test::PackedFile made = PackedSample::build();
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  for (const RenderMode mode : kModes) {
    for (const Filter filter : kFilters) {
      const Image expected = decoded_picture(grid, mode, filter);
      EXPECT_GT(shown(expected), 100) << render_mode_name(mode);
      for (const int threads : {1, 3}) {
        const CachedPicture found = cached_picture(grid, mode, filter, threads, 8);
        EXPECT_EQ(found.image.pixels, expected.pixels) << render_mode_name(mode) << ' ' << threads;
        EXPECT_LT(found.counts.decoded, found.counts.lookups);
        EXPECT_GT(found.counts.decoded, 32U);
        EXPECT_GT(found.counts.evicted, 0U);
      }
    }
  }
}

TEST(CachedPicture, LargerCache_DecodesLess) {
  const test::PackedFile made = PackedSample::build();
  const NvdbGrid grid = NvdbGrid::open(made.file, "a.nvdb");
  const CacheCounts small = cached_picture(grid, RenderMode::dvr, Filter::trilinear, 1, 4).counts;
  const CacheCounts large = cached_picture(grid, RenderMode::dvr, Filter::trilinear, 1, 100).counts;
  EXPECT_EQ(small.lookups, large.lookups);
  EXPECT_LT(2 * large.decoded, small.decoded);
}

class CpuBackendOfPackedFile : public testing::Test {
 protected:
  void write(const test::PackedFile& made) const {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(made.file.data()), static_cast<std::streamsize>(made.file.size()));
  }
  std::unique_ptr<LoadedVolume> load(Backend& backend) const {
    return backend.load(std::make_shared<const NvdbFile>(path_), 0, nullptr);
  }
  static Picture render(Backend& backend, LoadedVolume& volume, RenderMode mode = RenderMode::dvr) {
    return backend.render(volume, scene_of(mode), options_of(Filter::trilinear), {});
  }

  TemporaryDirectory directory_;
  std::string path_ = directory_ / "a.nvdb";
};

TEST_F(CpuBackendOfPackedFile, CeilingBelowTheDecodedBlocks_GivesTheSamePictureInThatMemory) {
  write(PackedSample::build());
  const auto decoding = make_cpu_backend(2);
  const auto caching = make_cpu_backend(2, {kCeiling});
  const auto decoded = load(*decoding);
  const auto cached = load(*caching);
  EXPECT_EQ(decoded->load_summary().way, "decoded");
  EXPECT_EQ(decoded->load_summary().note, "");
  EXPECT_GT(decoded->load_summary().memory, kCeiling);
  EXPECT_EQ(cached->load_summary().way, "cached");
  EXPECT_EQ(cached->load_summary().note, "all blocks decoded take 881.5 KiB, so they go through a cache, more slowly");
  EXPECT_LE(cached->load_summary().memory, kCeiling);
  for (const RenderMode mode : kModes) {
    const Picture first = render(*decoding, *decoded, mode);
    const Picture second = render(*caching, *cached, mode);
    EXPECT_EQ(first.image.pixels, second.image.pixels) << render_mode_name(mode);
    EXPECT_EQ(first.cache.lookups, 0U);
    EXPECT_GT(second.cache.lookups, 10 * second.cache.decoded);
    EXPECT_GT(second.cache.decoded, 0U);
  }
}

TEST_F(CpuBackendOfPackedFile, DamagedStream_EndsThePictureWithTheErrorOfTheEagerWay) {
  test::PackedFile made = PackedSample::build();
  const NvdbGrid whole = NvdbGrid::open(made.file, "a.nvdb");
  const GridBlock block = whole.block_at({200, 20, 30});
  ASSERT_TRUE(block.coded());
  made.file[static_cast<std::size_t>(block.stream.data - made.file.data())] |= std::byte{0x80};
  write(made);
  const auto decoding = make_cpu_backend(2);
  const std::string expected = message_of_error(ErrorKind::input, [&] { load(*decoding); });
  EXPECT_NE(expected.find("is damaged"), std::string::npos) << expected;
  for (const int threads : {1, 4}) {
    const auto caching = make_cpu_backend(threads, {kCeiling});
    const auto cached = load(*caching);
    EXPECT_EQ(message_of_error(ErrorKind::input, [&] { render(*caching, *cached); }), expected);
  }
}

}  // namespace
}  // namespace weir::cpu_backend_test
