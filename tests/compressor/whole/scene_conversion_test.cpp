// A scene decides what matters. What it shows is kept and certified, what it cannot show costs no byte, and pictures do
// not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "compressor/leaf/certificate.h"
#include "compressor/survey/visibility.h"
#include "format/base/error.h"
#include "format/leaf/bounds.h"
#include "format/nanovdb/read_box.h"
#include "format/sidecar/scene_opacity.h"
#include "tests/compressor/support/converted.h"

namespace weir::scene_conversion_test {
namespace {

using test::Converted;
using test::MemoryVolume;

// The domain lies in one node of each level.
constexpr Box kDomain{{3, 5, 0}, {76, 58, 41}};

// Smooth hills of three heights on a rippled ground: they have surfaces, and the ground and the inside are hidden.
float hills(const Index3& i) {
  const auto hill = [&](double x, double y, double z, double radius, double height) {
    const double dx = static_cast<double>(i.x) - x;
    const double dy = static_cast<double>(i.y) - y;
    const double dz = static_cast<double>(i.z) - z;
    return height * std::exp(-(dx * dx + dy * dy + dz * dz) / (radius * radius));
  };
  const double ground = 4 * std::sin(0.9 * static_cast<double>(i.x)) * std::cos(0.7 * static_cast<double>(i.y));
  return static_cast<float>(ground + hill(12, 20, 12, 9, 100) + hill(48, 40, 25, 12, 80) + hill(60, 12, 30, 6, 55));
}

MemoryVolume volume() { return {kDomain, hills}; }

// A scene that shows values from 40 on.
Scene surface() {
  Scene scene;
  scene.volume.range = {-10, 110};
  scene.volume.opacity = {{0, 0}, {50.0 / 120, 0}, {70.0 / 120, 0.3}, {1, 1}};
  return scene;
}

ConversionOptions options_for(const Scene& scene, Budget::Kind kind, double target = 0) {
  ConversionOptions options;
  options.scene = SceneFile{scene, "s.toml"};
  options.encoding = Encoding::automatic;
  options.budget.kind = kind;
  options.budget.target = target;
  options.budget.rate = target > 0 ? target : 8;
  options.non_finite = NonFinitePolicy::background;
  return options;
}

// The figures that the sidecar must have, found from every voxel and its 26 neighbours.
struct Seen {
  std::uint64_t blocks = 0;
  std::uint64_t voxels = 0;
  long double squared = 0;
  double max_abs = 0;
};

Seen seen_by_hand(const MemoryVolume& volume, const NvdbGrid& grid, const Scene& scene) {
  const Visibility visibility(scene, "s.toml", kDomain, Visibility::Weighing::alike);
  const NodeLattice leaves = make_lattice(kDomain, kLeafDim);
  Seen seen;
  std::vector<float> values(static_cast<std::size_t>(kDomain.voxels()));
  read_box(grid, kDomain, values);
  for (std::int64_t n = 0; n < leaves.size(); ++n) {
    const Box block = leaves.voxels(leaves.position(n));
    MinMax reach = kNoBounds;
    for_each_index(intersect(grown(block, 1), kDomain), [&](const Index3& i) {
      const float v = volume.at(i);
      widen(reach, {v, v});
    });
    if (!visibility.in_region(block) || !visibility.shows(reach)) continue;
    ++seen.blocks;
    for_each_index(block, [&](const Index3& i) {
      const float decoded = values[static_cast<std::size_t>(linear_index(i - kDomain.lo, kDomain.extent()))];
      const long double d = static_cast<long double>(volume.at(i)) - static_cast<long double>(decoded);
      ++seen.voxels;
      seen.squared += d * d;
      seen.max_abs = std::max(seen.max_abs, static_cast<double>(std::abs(d)));
    });
  }
  return seen;
}

struct SceneCase {
  Budget::Kind kind;
  Encoding encoding;
};

class SceneConversion : public testing::TestWithParam<SceneCase> {
 protected:
  static ConversionOptions options(const Scene& scene) {
    const auto [kind, encoding] = GetParam();
    const double rate = encoding == Encoding::packed ? 40 : 1.9;
    const double target = kind == Budget::Kind::psnr ? 50 : kind == Budget::Kind::max_error ? 0.5 : rate;
    ConversionOptions options = options_for(scene, kind, target);
    options.encoding = encoding;
    return options;
  }
};

TEST_P(SceneConversion, CertificateCoversTheVisibleVoxels) {
  MemoryVolume source = volume();
  const Budget::Kind kind = GetParam().kind;
  for (const bool region : {false, true}) {
    Scene scene = surface();
    if (region) scene.volume.region = Box{{0, 0, 0}, {30, 40, 40}};
    const Converted converted = convert(source, options(scene));
    ASSERT_TRUE(converted.sidecar.visible);
    const Sidecar::Visible& visible = *converted.sidecar.visible;
    const Seen seen = seen_by_hand(source, converted.grid(), scene);
    EXPECT_EQ(visible.scene, "s.toml");
    EXPECT_EQ(visible.blocks, seen.blocks);
    EXPECT_EQ(visible.voxels, seen.voxels);
    EXPECT_EQ(visible.error.max_abs, seen.max_abs);
    EXPECT_NEAR(visible.error.mse, static_cast<double>(seen.squared) / static_cast<double>(seen.voxels),
                1e-12 * visible.error.mse);
    EXPECT_EQ(visible.error.lossless, kind == Budget::Kind::lossless);
    EXPECT_FALSE(converted.sidecar.error.lossless) << "the ground is gone";
    if (kind == Budget::Kind::psnr) {
      EXPECT_GE(visible.error.psnr_db, 50);
    }
    if (kind == Budget::Kind::max_error) {
      EXPECT_LE(visible.error.max_abs, 0.5);
    }
  }
}

TEST_P(SceneConversion, FileIsSmallerThanWithoutTheScene) {
  if (GetParam().kind == Budget::Kind::rate) GTEST_SKIP() << "a rate is a size";
  MemoryVolume source = volume();
  ConversionOptions all = options(surface());
  const std::uint64_t weighed = convert(source, all).sidecar.file.bytes;
  all.scene.reset();
  EXPECT_LT(weighed, convert(source, all).sidecar.file.bytes);
}

TEST_P(SceneConversion, BytesDependOnNeitherThreadsNorMemory) {
  MemoryVolume source = volume();
  ConversionOptions some = options(surface());
  some.threads = 1;
  const Converted one = convert(source, some);
  some.threads = 3;
  some.memory = std::uint64_t{1} << 30U;
  source.set_access({4, {16, 16, 16}, {0, 0, 0}});
  EXPECT_EQ(convert(source, some).file, one.file);
}

std::string case_name(const testing::TestParamInfo<SceneCase>& info) {
  const std::string packed = info.param.encoding == Encoding::packed ? "Packed" : "";
  switch (info.param.kind) {
    case Budget::Kind::rate:
      return packed + "Rate";
    case Budget::Kind::psnr:
      return packed + "Psnr";
    case Budget::Kind::max_error:
      return packed + "MaxError";
    default:
      return packed + "Lossless";
  }
}

INSTANTIATE_TEST_SUITE_P(Budgets, SceneConversion,
                         testing::Values(SceneCase{Budget::Kind::rate, Encoding::automatic},
                                         SceneCase{Budget::Kind::psnr, Encoding::automatic},
                                         SceneCase{Budget::Kind::max_error, Encoding::automatic},
                                         SceneCase{Budget::Kind::lossless, Encoding::automatic},
                                         SceneCase{Budget::Kind::rate, Encoding::packed},
                                         SceneCase{Budget::Kind::psnr, Encoding::packed},
                                         SceneCase{Budget::Kind::max_error, Encoding::packed},
                                         SceneCase{Budget::Kind::lossless, Encoding::packed}),
                         case_name);

// Interpolates trilinearly and clamps to the domain, as a renderer does.
double lookup(const std::array<double, 3>& p, const auto& value) {
  double sum = 0;
  const std::array<std::int64_t, 3> lo{kDomain.lo.x, kDomain.lo.y, kDomain.lo.z};
  const std::array<std::int64_t, 3> hi{kDomain.hi.x - 1, kDomain.hi.y - 1, kDomain.hi.z - 1};
  for (unsigned corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<std::int64_t, 3> i{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double floor = std::floor(p[axis]);
      const bool up = (corner >> axis & 1U) != 0;
      weight *= up ? p[axis] - floor : 1 - (p[axis] - floor);
      i[axis] = std::clamp(static_cast<std::int64_t>(floor) + (up ? 1 : 0), lo[axis], hi[axis]);
    }
    sum += weight * static_cast<double>(value(Index3{i[0], i[1], i[2]}));
  }
  return sum;
}

// Every lookup gives the same opacity as before and, if not transparent, the same value. So a picture does not change.
TEST(ScenePictures, LosslessVisibleBlocksLeaveThePictureUnchanged) {
  for (const bool holes : {false, true}) {
    MemoryVolume source(kDomain, [&](const Index3& i) {
      if (holes && i.x % 16 < 8 && i.y > 30) return std::numeric_limits<float>::quiet_NaN();
      return hills(i);
    });
    ConversionOptions options = options_for(surface(), Budget::Kind::lossless);
    options.background = holes ? 30.0F : 0.0F;
    const Converted converted = convert(source, options);
    const NvdbGrid grid = converted.grid();
    EXPECT_LT(converted.sidecar.visible->blocks, converted.sidecar.selection.leaves_total / 2) << "much is hidden";
    const std::vector<float> table = opacity_table(surface().volume.opacity);
    const auto opacity = [&](double v) {
      const double u = std::clamp((v + 10) / 120, 0.0, 1.0) * 1023;
      const auto i = static_cast<std::size_t>(u);
      return static_cast<double>(table[i]) +
             (u - std::floor(u)) * static_cast<double>(table[std::min<std::size_t>(i + 1, 1023)] - table[i]);
    };
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    int shown = 0;
    for (int n = 0; n < 60000; ++n) {
      const std::array<double, 3> p{3 + 72 * uniform(random), 5 + 52 * uniform(random), 40 * uniform(random)};
      const double before = lookup(p, [&](const Index3& i) {
        const float v = source.at(i);
        return std::isfinite(v) ? v : *options.background;
      });
      const double after = lookup(p, [&](const Index3& i) { return grid.value(i); });
      ASSERT_NEAR(opacity(after), opacity(before), 1e-9) << p[0] << ' ' << p[1] << ' ' << p[2];
      if (opacity(before) > 0) {
        ++shown;
        ASSERT_NEAR(after, before, 1e-6) << p[0] << ' ' << p[1] << ' ' << p[2];
      }
    }
    EXPECT_GT(shown, 1000);
  }
}

TEST(ScenePictures, AnIsoSurfaceKeepsTheBlocksItRunsThrough) {
  MemoryVolume source = volume();
  Scene scene;
  scene.mode = RenderMode::iso;
  scene.volume.iso = 50;
  const Converted converted = convert(source, options_for(scene, Budget::Kind::lossless));
  const Seen seen = seen_by_hand(source, converted.grid(), scene);
  EXPECT_EQ(converted.sidecar.visible->blocks, seen.blocks);
  EXPECT_EQ(seen.max_abs, 0);
  EXPECT_TRUE(converted.sidecar.visible->error.lossless);
  EXPECT_LT(seen.blocks, 90U);
}

TEST(ScenePictures, NothingVisible_GivesTheSmallestTree) {
  MemoryVolume source = volume();
  Scene scene = surface();
  scene.volume.range = {1000, 2000};
  const Converted converted = convert(source, options_for(scene, Budget::Kind::lossless));
  EXPECT_EQ(converted.sidecar.visible->blocks, 0U);
  EXPECT_EQ(converted.sidecar.visible->voxels, 0U);
  EXPECT_TRUE(converted.sidecar.visible->error.lossless);
  EXPECT_EQ(converted.sidecar.selection.leaves_kept, 2U) << "the corners";
  scene.volume.range = {1000, 2000};
  ConversionOptions larger = options_for(scene, Budget::Kind::rate, 1);
  const Converted padded = convert(source, larger);
  ASSERT_EQ(padded.notices.size(), 2U);
  EXPECT_NE(padded.notices[0].find("what the scene shows takes no more than "), std::string::npos) << padded.notices[0];
  EXPECT_NE(padded.notices[1].find(" shows nothing of "), std::string::npos) << padded.notices[1];
}

TEST(ScenePictures, VisibleBackgroundFill_KeepsHiddenBlocksToo) {
  // The ground cannot be seen, but the value of a dropped block could be.
  MemoryVolume source = volume();
  ConversionOptions options = options_for(surface(), Budget::Kind::lossless);
  options.fill = FillMode::background;
  options.background = 90.0F;
  const Converted converted = convert(source, options);
  EXPECT_TRUE(converted.sidecar.error.lossless);
  EXPECT_TRUE(converted.sidecar.visible->error.lossless);
  options.background = 0.0F;
  EXPECT_FALSE(convert(source, options).sidecar.error.lossless);
}

TEST(ScenePictures, SceneLowersTheVisibleErrorAtTheSameSize) {
  MemoryVolume source = volume();
  ConversionOptions with = options_for(surface(), Budget::Kind::rate, 1.85);
  const Converted weighed = convert(source, with);
  with.scene.reset();
  const Converted plain = convert(source, with);
  ASSERT_EQ(weighed.sidecar.file.bytes, plain.sidecar.file.bytes);
  const Seen before = seen_by_hand(source, plain.grid(), surface());
  const Seen after = seen_by_hand(source, weighed.grid(), surface());
  EXPECT_LT(after.squared, 0.5L * before.squared);
}

TEST(ScenePictures, SceneWithAPaperMetricIsRefused) {
  MemoryVolume source = volume();
  ConversionOptions options = options_for(surface(), Budget::Kind::rate);
  options.metric = Metric::farthest;
  try {
    convert(source, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_STREQ(error.what(), "--scene weighs squared errors, --metric farthest has none; use --metric sse");
  }
}

}  // namespace
}  // namespace weir::scene_conversion_test
