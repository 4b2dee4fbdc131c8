// A device refuses memory at some moment of a load or a picture. Either the picture is the same, or there is an error
// of one line that says what to do. Nothing stays behind, and the next picture is right.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "gpu/cuda/render/cuda_backend.h"
#include "gpu/cuda/runtime/device_array.h"
#include "gpu/cuda/volume/device_memory.h"
#include "gpu/render/playback.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/cuda/support/packed_ball.h"
#include "tests/cuda/support/process_resources.h"
#include "tests/cuda/support/refused_allocations.h"
#include "tests/support/temporary_directory.h"

namespace weir::refused_memory_test {
namespace {

using test::RefusedAllocations;

struct Case {
  std::string name;
  int edge = 200;  // voxels
  std::optional<std::uint64_t> memory = std::nullopt;
  bool levels = false;
  RenderMode mode = RenderMode::dvr;
  float odd = 0.5F;
};

class RefusedMemory : public testing::Test {
 protected:
  void SetUp() override { WEIR_NEEDS_DEVICE(); }

  static std::unique_ptr<Backend> cuda(const Case& tried) {
    CudaOptions options;
    options.memory = tried.memory;
    options.levels = tried.levels;
    return make_cuda_backend(options);
  }
  std::shared_ptr<const NvdbFile> file(const Case& tried) const {
    return test::written(path_, test::packed_ball(tried.edge, tried.odd).file);
  }

  static Picture picture(Backend& backend, LoadedVolume& volume, const Case& tried, std::int32_t width = 48) {
    Scene scene;
    scene.mode = tried.mode;
    scene.volume.density = 20;
    RenderOptions options;
    options.width = width;
    options.height = 36;
    if (tried.levels) options.levels = LevelOfDetail{-1.2F, 0};
    return backend.render(volume, scene, options, {1, nullptr, {}});
  }

  static std::uint64_t step_of(const Case& tried) { return tried.edge > 100 ? test::refusal_step() : 1; }

  // Expects one line that says what was refused and what to do.
  static void expect_clear(const Error& error, const std::string& place) {
    const std::string message = error.what();
    EXPECT_EQ(error.kind(), ErrorKind::io) << message;
    EXPECT_NE(message.find(place), std::string::npos) << message;
    EXPECT_NE(message.find("cudaErrorMemoryAllocation, "), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    if (message.find(": cannot be brought to the device: ") == std::string::npos) {
      EXPECT_NE(message.find("--backend cpu"), std::string::npos) << message;
    }
  }

  // Refuses each allocation of a load and a picture in turn.
  void expect_picture_or_error(const Case& tried, bool lasting) {
    SCOPED_TRACE(tried.name + (lasting ? ", this and all later ones" : ", this one"));
    const auto grid = file(tried);
    const auto backend = cuda(tried);
    const auto whole = [&] {
      const auto volume = backend->load(grid, 16, nullptr);
      return picture(*backend, *volume, tried).image;
    };
    whole();  // allocates once what CUDA itself needs
    const std::uint64_t before = test::allocations();
    const Image expected = whole();
    const std::uint64_t count = test::allocations() - before;
    ASSERT_GT(count, 20U);
    const std::uint64_t pool = test::pool_bytes();
    const std::size_t used = test::used_device_bytes();
    std::uint64_t refusals = 0;
    std::uint64_t errors = 0;
    for (std::uint64_t n = 0; n < count; n += step_of(tried), ++refusals) {
      try {
        const RefusedAllocations refused(n, lasting);
        EXPECT_EQ(whole().pixels, expected.pixels) << n;
      } catch (const Error& error) {
        ++errors;
        expect_clear(error, "");
      }
      ASSERT_EQ(test::pool_bytes(), pool) << n;
    }
    EXPECT_EQ(whole().pixels, expected.pixels);
    EXPECT_LE(test::used_device_bytes(), used + (std::size_t{16} << 20U)) << "less than a texture";
    if (lasting) {
      EXPECT_GT(errors, refusals / 2);
    } else {
      EXPECT_LT(errors, refusals / 2) << "most have another way";
    }
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_ / "grid.nvdb";
};

const Case kAll{"all bricks", 64};
const Case kSome{"a cache", 240, std::uint64_t{70} << 20U};  // large enough that a smaller cache works, too
const Case kLevels{"a cache with levels", 200, test::kSmallCacheWithLevels, true};
const Case kUnfit{"a cache made again with floats",      240, std::uint64_t{70} << 20U, false, RenderMode::mip,
                  std::numeric_limits<float>::infinity()};

TEST_F(RefusedMemory, OfAllBricks_OneAllocation) { expect_picture_or_error(kAll, false); }
TEST_F(RefusedMemory, OfAllBricks_AllFromOneOn) { expect_picture_or_error(kAll, true); }
TEST_F(RefusedMemory, OfACache_OneAllocation) { expect_picture_or_error(kSome, false); }
TEST_F(RefusedMemory, OfACache_AllFromOneOn) { expect_picture_or_error(kSome, true); }
TEST_F(RefusedMemory, OfLevels_OneAllocation) { expect_picture_or_error(kLevels, false); }
TEST_F(RefusedMemory, OfLevels_AllFromOneOn) { expect_picture_or_error(kLevels, true); }

// The second frame has another size. Either the volume's memory makes room for it, or it fails and the third frame
// works.
TEST_F(RefusedMemory, InTheMiddle_AFrameOfAnotherSizeIsDrawnOrFailsAndTheNextOneIsRight) {
  for (const Case& tried : {kAll, kSome, kLevels}) {
    SCOPED_TRACE(tried.name);
    const auto grid = file(tried);
    const auto backend = cuda(tried);
    auto volume = backend->load(grid, 16, nullptr);
    const Image small = picture(*backend, *volume, tried).image;
    picture(*backend, *volume, tried, 80);
    const std::uint64_t before = test::allocations();
    const Image expected = picture(*backend, *volume, tried, 80).image;
    const std::uint64_t count = test::allocations() - before;
    ASSERT_GE(count, 3U);
    for (std::uint64_t n = 0; n < count; ++n) {
      for (const bool lasting : {false, true}) {
        if (lasting || n == 0) volume = backend->load(grid, 16, std::move(volume));  // as large as it was before
        picture(*backend, *volume, tried);
        try {
          const RefusedAllocations refused(n, lasting);
          const Picture drawn = picture(*backend, *volume, tried, 80);
          EXPECT_FALSE(lasting) << n;
          EXPECT_EQ(drawn.image.pixels, expected.pixels) << n;
          EXPECT_NE(drawn.memory_note.find("cudaErrorMemoryAllocation"), std::string::npos) << drawn.memory_note;
        } catch (const Error& error) {
          expect_clear(error, "a picture of 80 x 36 pixels: ");
        }
        EXPECT_EQ(picture(*backend, *volume, tried, 80).image.pixels, expected.pixels) << n;
        EXPECT_EQ(picture(*backend, *volume, tried).image.pixels, small.pixels) << n;
      }
    }
  }
}

// A brick that 16 bits do not hold appears while a picture is drawn, and the cache is made again.
TEST_F(RefusedMemory, WhileACacheIsMadeAgainWithFloats_ThePictureIsRightOrFails) {
  const auto grid = file(kUnfit);
  const auto backend = cuda(kUnfit);
  const auto load = [&] { return backend->load(grid, 16, nullptr); };
  auto volume = load();
  const std::uint64_t before = test::allocations();
  const Image expected = picture(*backend, *volume, kUnfit).image;
  const std::uint64_t count = test::allocations() - before;
  for (std::uint64_t n = 0; n < count; n += step_of(kUnfit)) {
    for (const bool lasting : {false, true}) {
      volume.reset();
      volume = load();
      try {
        const RefusedAllocations refused(n, lasting);
        EXPECT_EQ(picture(*backend, *volume, kUnfit).image.pixels, expected.pixels) << n;
      } catch (const Error& error) {
        expect_clear(error, "a picture of 48 x 36 pixels: ");
      }
      EXPECT_EQ(picture(*backend, *volume, kUnfit).image.pixels, expected.pixels) << n;
    }
  }
}

// The next step of a series finds no room beside the one that is drawn.
TEST_F(RefusedMemory, InTheMiddle_AnotherStepOfASeries) {
  const Case tried{"a series", 64};
  const auto grid = file(tried);
  const auto backend = cuda(tried);
  const std::vector<std::string> files(4, path_);
  std::vector<Image> frames;
  const auto run = [&] {
    frames.clear();
    RenderOptions options;
    options.width = 48;
    options.height = 36;
    play(*backend, files, {}, options, {}, [&](std::size_t, const Picture& drawn) { frames.push_back(drawn.image); });
  };
  run();
  const std::vector<Image> expected = frames;
  const std::uint64_t before = test::allocations();
  run();
  const std::uint64_t count = test::allocations() - before;
  for (std::uint64_t n = 0; n < count; n += test::refusal_step()) {
    try {
      const RefusedAllocations refused(n, false);
      run();
      EXPECT_EQ(frames.size(), 4U) << n;
    } catch (const Error& error) {
      expect_clear(error, "");
    }
    for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frames[i].pixels, expected[i].pixels) << n << ' ' << i;
  }
}

// Other programs really take the memory of the device.
TEST_F(RefusedMemory, ByADeviceThatIsFull_APictureFailsOrIsRightAndTheNextOneIsRight) {
  const auto grid = file(kSome);
  const auto backend = cuda(kSome);
  const auto volume = backend->load(grid, 16, nullptr);
  const Image expected = picture(*backend, *volume, kSome, 800).image;
  {
    std::vector<DeviceArray<std::byte>> others;
    free_device_bytes(~std::uint64_t{0});
    for (std::uint64_t bytes = std::uint64_t{1} << 36U; bytes >= (std::uint64_t{1} << 20U);) {
      try {
        others.emplace_back(bytes);
      } catch (const DeviceFull&) {
        bytes /= 2;
      }
    }
    try {
      const Picture drawn = picture(*backend, *volume, kSome, 800);
      EXPECT_EQ(drawn.image.pixels, expected.pixels);
    } catch (const Error& error) {
      expect_clear(error, "a picture of 800 x 36 pixels: ");
    }
    try {
      const auto second = backend->load(grid, 16, nullptr);
      EXPECT_EQ(picture(*backend, *second, kSome, 800).image.pixels, expected.pixels);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("cudaErrorMemoryAllocation"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(picture(*backend, *volume, kSome, 800).image.pixels, expected.pixels);
}

}  // namespace
}  // namespace weir::refused_memory_test
