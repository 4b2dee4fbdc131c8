#include "gpu/cuda/render/cuda_backend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <regex>

#include "format/base/error.h"
#include "gpu/cuda/render/device_volume.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/volume/device_memory.h"
#include "tests/cuda/support/device_reads.h"
#include "tests/cuda/support/refused_allocations.h"
#include "tests/stock/test_grid.h"
#include "tests/support/temporary_directory.h"

namespace weir::cuda_backend_test {
namespace {

using test::TestGrid;
using test::TestGridOptions;

float ball(const Index3& i) {
  const auto x = static_cast<float>(i.x - 20);
  const auto y = static_cast<float>(i.y - 20);
  const auto z = static_cast<float>(i.z - 20);
  return greater(0.0F, 1 - std::sqrt(x * x + y * y + z * z) / 20) * (1.2F + std::sin(0.9F * x) * std::cos(0.7F * y));
}

class CudaBackendTest : public testing::Test {
 protected:
  void SetUp() override { WEIR_NEEDS_DEVICE(); }

  std::shared_ptr<const NvdbFile> file(const TestGrid& grid) {
    const std::string path = (directory_.path() / "grid.nvdb").string();
    const auto bytes = grid.grid().bytes();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return std::make_shared<const NvdbFile>(path);
  }

  static Image picture(Backend& backend, const std::shared_ptr<const NvdbFile>& file, const Scene& scene, Filter filter,
                       std::uint64_t seed, std::uint32_t samples, std::int32_t width = 48) {
    const auto volume = backend.load(file, 16, nullptr);
    RenderOptions options;
    options.width = width;
    options.height = width * 3 / 4;
    options.filter = filter;
    options.seed = seed;
    return backend.render(*volume, scene, options, {samples, nullptr, {}}).image;
  }

  TemporaryDirectory directory_;
};

constexpr std::array kTypes{GridType::float32, GridType::fp4, GridType::fp8, GridType::fp16, GridType::fpn};
constexpr std::array kFilters{Filter::nearest, Filter::trilinear, Filter::stochastic};

/// Returns the largest difference of any channel, without the share `outliers` of the pixels that differ most.
float difference(const Image& a, const Image& b, double outliers) {
  std::vector<float> differences;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Float3 d = a.pixels[i] - b.pixels[i];
    differences.push_back(greater(std::abs(d.x), greater(std::abs(d.y), std::abs(d.z))));
  }
  std::sort(differences.begin(), differences.end());
  return differences[static_cast<std::size_t>(static_cast<double>(differences.size() - 1) * (1 - outliers))];
}

// Without scattering, both back ends compute the same numbers except for rounding. Rounding makes few rays hit or
// miss an edge.
TEST_F(CudaBackendTest, MarchedPicturesAreTheCpus) {
  CudaOptions options;
  options.atlas = false;
  const auto cuda = make_cuda_backend(options);
  const auto cpu = make_cpu_backend(0);
  for (const GridType type : kTypes) {
    TestGridOptions grid_options;
    grid_options.type = type;
    const auto grid = file(TestGrid({{0, 0, 0}, {41, 41, 41}}, ball, grid_options));
    for (const RenderMode mode : {RenderMode::dvr, RenderMode::iso, RenderMode::mip}) {
      for (const Filter filter : kFilters) {
        Scene scene;
        scene.mode = mode;
        const Image expected = picture(*cpu, grid, scene, filter, 3, 2);
        const Image image = picture(*cuda, grid, scene, filter, 3, 2);
        EXPECT_LT(difference(image, expected, 0.02), 2e-3F)
            << grid_type_name(type) << ' ' << render_mode_name(mode) << ' ' << static_cast<int>(filter);
      }
    }
  }
}

// The mean over pixels of the squared difference of two pictures, in units of its variance. It is 1 if both are drawn
// from one distribution.
struct Agreement {
  double z2 = 0;    ///< mean over pixels of z^2
  double bias = 0;  ///< deviation of the mean over all pixels, in standard deviations
};

template <class Draw>
void statistics(const Draw& draw, int batches, std::vector<double>& mean, std::vector<double>& variance) {
  for (int b = 0; b < batches; ++b) {
    const Image image = draw(b);
    mean.resize(image.pixels.size());
    variance.resize(image.pixels.size());
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const double v = image.pixels[i].x + image.pixels[i].y + image.pixels[i].z;
      mean[i] += v / batches;
      variance[i] += v * v / batches;
    }
  }
  for (std::size_t i = 0; i < mean.size(); ++i) {
    variance[i] = std::max(0.0, variance[i] - mean[i] * mean[i]) / (batches - 1);
  }
}

template <class A, class B>
Agreement compare(const A& a, const B& b, int batches) {
  std::vector<double> mean_a;
  std::vector<double> mean_b;
  std::vector<double> var_a;
  std::vector<double> var_b;
  statistics(a, batches, mean_a, var_a);
  statistics(b, batches, mean_b, var_b);
  Agreement result;
  double difference = 0;
  double variance = 0;
  int counted = 0;
  for (std::size_t i = 0; i < mean_a.size(); ++i) {
    const double var = var_a[i] + var_b[i];
    if (var < 1e-12) continue;
    ++counted;
    result.z2 += (mean_a[i] - mean_b[i]) * (mean_a[i] - mean_b[i]) / var;
    difference += mean_a[i] - mean_b[i];
    variance += var;
  }
  EXPECT_GT(counted, 200) << "the volume fills too little of the picture";
  result.z2 /= counted;
  result.bias = difference / std::sqrt(variance);
  return result;
}

// z^2 has the mean (n - 1) / (n - 3) for n - 1 = 30 degrees of freedom; over 1000 pixels this is 1.07 within 0.15.
void expect_one_distribution(const Agreement& agreement, const std::string& what) {
  EXPECT_GT(agreement.z2, 0.85) << what;
  EXPECT_LT(agreement.z2, 1.3) << what;
  EXPECT_LT(std::abs(agreement.bias), 4) << what;
}

TEST_F(CudaBackendTest, PathTracedPicturesAgreeWithTheCpuWithinTheirNoise) {
  const auto cpu = make_cpu_backend(0);
  for (const bool atlas : {false, true}) {
    CudaOptions options;
    options.atlas = atlas;
    const auto cuda = make_cuda_backend(options);
    for (const GridType type : {GridType::float32, GridType::fpn}) {
      TestGridOptions grid_options;
      grid_options.type = type;
      const auto grid = file(TestGrid({{0, 0, 0}, {41, 41, 41}}, ball, grid_options));
      for (const Filter filter : {Filter::trilinear, Filter::stochastic}) {
        if (atlas && filter == Filter::stochastic) continue;
        Scene scene;
        scene.volume.anisotropy = 0.4;
        scene.volume.density = 60;
        const auto draw = [&](Backend& backend, int offset) {
          return [&, offset](int batch) {
            return picture(backend, grid, scene, filter, static_cast<std::uint64_t>(offset + batch), 8);
          };
        };
        expect_one_distribution(compare(draw(*cpu, 100), draw(*cuda, 900), 16),
                                cat(grid_type_name(type), atlas ? " atlas " : " table ", static_cast<int>(filter)));
      }
    }
  }
}

// A hang would show as a test that never ends. The pictures are the CPU's.
TEST_F(CudaBackendTest, OddVolumesAndCameras) {
  const auto cuda = make_cuda_backend({});
  const auto cpu = make_cpu_backend(0);
  TestGridOptions tiles;
  tiles.tiles = {{{0, 0, 0}, 128, 0.75F, true}, {{128, 0, 0}, 128, 0.5F, true}};
  struct Case {
    std::string name;
    TestGrid grid;
    Scene scene;
    std::uint32_t path_samples = 64;
  };
  Scene plain;
  Scene extreme;
  extreme.volume.density = 1e30;
  Scene inside;
  inside.camera.position = Double3{15.5, 15.5, 15.5};  // the corner of eight cells
  inside.camera.look_at = Double3{31.5, 15.5, 15.5};   // looks along the cells' edges
  Scene axis;
  axis.camera.azimuth = 0;
  axis.camera.elevation = 0;
  const auto wave = [](const Index3& i) { return 0.5F + 0.5F * std::sin(0.01F * static_cast<float>(i.x)); };
  std::vector<Case> cases;
  cases.push_back({"longer than a root tile", TestGrid({{0, 0, 0}, {5000, 9, 4}}, wave), plain});
  cases.push_back({"one voxel thick", TestGrid({{0, 0, 0}, {60, 1, 50}}, wave), plain});
  cases.push_back({"one voxel", TestGrid({{4, 5, 6}, {5, 6, 7}}, wave), plain});
  cases.push_back({"tiles only", TestGrid({}, wave, tiles), plain});
  cases.push_back({"a wall", TestGrid({{0, 0, 0}, {41, 41, 41}}, ball), extreme, 8});
  cases.push_back({"from inside, on borders", TestGrid({{0, 0, 0}, {41, 41, 41}}, ball), inside});
  cases.push_back({"along an axis", TestGrid({{0, 0, 0}, {41, 41, 41}}, ball), axis});
  for (const Case& c : cases) {
    const auto grid = file(c.grid);
    for (const RenderMode mode : {RenderMode::path, RenderMode::dvr, RenderMode::iso, RenderMode::mip}) {
      Scene scene = c.scene;
      scene.mode = mode;
      const std::uint32_t samples = mode == RenderMode::path ? c.path_samples : 4;
      const Image expected = picture(*cpu, grid, scene, Filter::stochastic, 5, samples, 24);
      const Image image = picture(*cuda, grid, scene, Filter::stochastic, 5, samples, 24);
      double a = 0;
      double b = 0;
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        ASSERT_TRUE(is_finite(image.pixels[i].x + image.pixels[i].y + image.pixels[i].z)) << c.name;
        a += image.pixels[i].x + image.pixels[i].y + image.pixels[i].z;
        b += expected.pixels[i].x + expected.pixels[i].y + expected.pixels[i].z;
      }
      EXPECT_NEAR(a / b, 1, 0.02) << c.name << ' ' << render_mode_name(mode);
    }
  }
}

TEST_F(CudaBackendTest, SamplesOfSeveralPassesAddUp) {
  const auto cuda = make_cuda_backend({});
  const auto grid = file(TestGrid({{0, 0, 0}, {41, 41, 41}}, ball));
  const Image a = picture(*cuda, grid, {}, Filter::stochastic, 1, 40);
  const Image b = picture(*cuda, grid, {}, Filter::stochastic, 1, 40);
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_NE(a.pixels, picture(*cuda, grid, {}, Filter::stochastic, 2, 40).pixels);
}

TEST_F(CudaBackendTest, AnInterruptionIsAnError) {
  const auto cuda = make_cuda_backend({});
  const auto grid = file(TestGrid({{0, 0, 0}, {41, 41, 41}}, ball));
  const auto volume = cuda->load(grid, 0, nullptr);
  const std::atomic<bool> cancel{true};
  try {
    cuda->render(*volume, {}, {}, {4, &cancel, {}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
    EXPECT_STREQ(error.what(), "interrupted; no image was written");
  }
}

TEST_F(CudaBackendTest, AGridThatTheDeviceHasNoRoomForStaysInHostMemory) {
  const auto cuda = make_cuda_backend({});
  const auto grid = file(TestGrid({{0, 0, 0}, {41, 41, 41}}, ball));
  const Image expected = picture(*cuda, grid, {}, Filter::stochastic, 1, 16);
  const auto others = [&] {  // takes so much memory that half of what a back end leaves free remains
    const std::uint64_t free = free_device_bytes(std::numeric_limits<std::uint64_t>::max());
    void* memory = nullptr;
    check_cuda(cudaMalloc(&memory, free - kSpareDeviceBytes / 2), "test");
    return std::unique_ptr<void, cudaError_t (*)(void*)>(memory, cudaFree);
  }();
  const auto volume = cuda->load(grid, 16, nullptr);
  const LoadSummary& summary = volume->load_summary();
  EXPECT_TRUE(summary.way.ends_with(", zero-copy")) << summary.way;
  const std::regex note(
      "the grid needs 51\\d\\.\\d+ MiB of device memory and 25\\d\\.\\d+ MiB are free, "
      "so it stays in host memory.*");
  EXPECT_TRUE(std::regex_match(summary.note, note)) << summary.note;
  EXPECT_EQ(picture(*cuda, grid, {}, Filter::stochastic, 1, 16).pixels, expected.pixels);
  EXPECT_EQ(picture(*cuda, grid, {}, Filter::trilinear, 1, 16).pixels.size(), expected.pixels.size())
      << "without room for an atlas";
}

TEST_F(CudaBackendTest, APictureThatIsRefusedMemoryDoesWithoutTheAtlas) {
  const auto cuda = make_cuda_backend({});
  const auto grid = file(TestGrid({{0, 0, 0}, {41, 41, 41}}, ball));
  Scene scene;
  scene.mode = RenderMode::dvr;
  const auto load = [&] { return cuda->load(grid, 16, nullptr); };
  const auto draw = [&](LoadedVolume& volume) { return cuda->render(volume, scene, {}, {1, nullptr, {}}); };
  auto volume = load();
  const Picture expected = draw(*volume);
  const std::uint64_t before = test::allocations();
  draw(*volume);
  const std::uint64_t count = test::allocations() - before;
  ASSERT_GE(count, 3U);
  for (std::uint64_t n = 0; n < count; ++n) {
    volume = load();
    EXPECT_EQ(draw(*volume).memory_note, "");
    const test::RefusedAllocations refused(n, false);
    const Picture found = draw(*volume);
    EXPECT_LT(difference(found.image, expected.image, 0.02), 0.02F) << n;
    EXPECT_TRUE(found.memory_note.ends_with("its voxels are looked up without bricks, more slowly"))
        << found.memory_note;
  }
}

TEST_F(CudaBackendTest, SeveralDevicesDrawTheSamePicture) {
  if (device_count() < 2) GTEST_SKIP() << "one CUDA device";
  CudaOptions two;
  two.devices = {0, 1};
  const auto grid = file(TestGrid({{0, 0, 0}, {41, 41, 41}}, ball));
  const Image one = picture(*make_cuda_backend({}), grid, {}, Filter::stochastic, 1, 64);
  const Image both = picture(*make_cuda_backend(two), grid, {}, Filter::stochastic, 1, 64);
  EXPECT_LT(difference(one, both, 0), 1e-4F) << "the same samples, added in another order";
}

TEST_F(CudaBackendTest, LoadsAndUnloadsWithoutALeak) {
  const auto cuda = make_cuda_backend({});
  const auto grid = file(TestGrid({{0, 0, 0}, {41, 41, 41}}, ball));
  const auto used = [] {
    cudaDeviceSynchronize();
    cudaMemPool_t pool = nullptr;
    std::uint64_t bytes = 0;
    check_cuda(cudaDeviceGetDefaultMemPool(&pool, 0), "test");
    check_cuda(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrUsedMemCurrent, &bytes), "test");
    std::size_t free = 0;
    std::size_t total = 0;
    check_cuda(cudaMemGetInfo(&free, &total), "test");
    return std::pair<std::uint64_t, std::size_t>(bytes, free);
  };
  std::unique_ptr<LoadedVolume> volume = cuda->load(grid, 0, nullptr);
  RenderOptions options;
  options.width = options.height = 8;
  cuda->render(*volume, {}, options, {});
  volume.reset();
  const auto [bytes, free] = used();
  for (int i = 0; i < 1000; ++i) {
    volume = cuda->load(grid, 0, i % 2 == 0 ? nullptr : std::move(volume));
    if (i % 100 == 0) cuda->render(*volume, {}, options, {});
  }
  volume.reset();
  const auto [bytes_after, free_after] = used();
  EXPECT_EQ(bytes_after, bytes);
  EXPECT_GE(free_after + (1U << 20U), free);
}

}  // namespace
}  // namespace weir::cuda_backend_test
