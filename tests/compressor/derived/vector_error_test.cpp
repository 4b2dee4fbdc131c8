#include "compressor/derived/vector_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "tests/compressor/support/converted.h"

namespace weir::vector_error_test {
namespace {

using Component = std::function<double(const Index3&)>;
using Field = std::array<Component, 3>;

const Box kDomain{{-5, 3, -20}, {30, 20, 7}};

test::MemoryVolume volume_of(const Component& component, const Box& domain) {
  test::MemoryVolume volume(domain, [&](const Index3& i) { return static_cast<float>(component(i)); });
  volume.info().spacing = {0.5, 0.5, 2};
  volume.info().path = "in.raw";
  return volume;
}

/// Returns the errors of lossless files of `kept` against `source`.
VectorErrors errors_of(const Field& source, const Field& kept, const CompareOptions& options = {}) {
  std::vector<test::MemoryVolume> sources;
  std::vector<test::Converted> files;
  std::vector<NvdbGrid> grids;
  for (std::size_t c = 0; c < 3; ++c) {
    test::MemoryVolume made_from = volume_of(kept[c], kDomain);
    ConversionOptions lossless;
    lossless.budget.kind = Budget::Kind::lossless;
    files.push_back(test::convert(made_from, lossless));
    sources.push_back(volume_of(source[c], kDomain));
  }
  for (const test::Converted& file : files) grids.push_back(file.grid());
  return vector_errors({{{sources[0], grids[0]}, {sources[1], grids[1]}, {sources[2], grids[2]}}}, options);
}

double x(const Index3& i) { return 0.5 * static_cast<double>(i.x); }
double y(const Index3& i) { return 0.5 * static_cast<double>(i.y); }
double z(const Index3& i) { return 2.0 * static_cast<double>(i.z); }
double none(const Index3&) { return 0; }

/// Returns the velocity of a rotation about the z axis by `omega` radians per unit of time.
Field rotation(double omega) {
  return {[=](const Index3& i) { return -omega * y(i); }, [=](const Index3& i) { return omega * x(i); }, none};
}

// The vorticity of a solid body is twice its rate of rotation, and its divergence is 0.
TEST(VectorErrors, OfASolidBodyThatRotatesTooFast) {
  const VectorErrors found = errors_of(rotation(1.5), rotation(2));
  EXPECT_EQ(found.voxels, static_cast<std::uint64_t>(kDomain.voxels()));
  EXPECT_EQ(found.left_out, 0U);
  EXPECT_DOUBLE_EQ(found.vorticity.source_rms, 3);
  EXPECT_DOUBLE_EQ(found.vorticity.rms, 1);
  EXPECT_DOUBLE_EQ(found.vorticity.max_abs, 1);
  EXPECT_DOUBLE_EQ(*found.vorticity.relative_rms, 1.0 / 3);
  EXPECT_EQ(found.divergence.source_rms, 0);
  EXPECT_EQ(found.divergence.rms, 0);
  EXPECT_EQ(found.divergence.relative_rms, std::nullopt);
}

TEST(VectorErrors, OfAFieldThatGrowsTooMuchInEveryDirection) {
  const Field source{x, y, z};
  const Field kept{[](const Index3& i) { return 1.25 * x(i); }, y, [](const Index3& i) { return 1.5 * z(i); }};
  const VectorErrors found = errors_of(source, kept);
  EXPECT_DOUBLE_EQ(found.divergence.source_rms, 3);
  EXPECT_DOUBLE_EQ(found.divergence.rms, 0.75);
  EXPECT_DOUBLE_EQ(found.divergence.max_abs, 0.75);
  EXPECT_DOUBLE_EQ(*found.divergence.relative_rms, 0.25);
  EXPECT_EQ(found.vorticity.source_rms, 0);
  EXPECT_EQ(found.vorticity.rms, 0);
}

// Each part of the vorticity counts with its sign. The parts of one axis do not hide those of another.
TEST(VectorErrors, EveryPartOfTheVorticityCounts) {
  const Field still{none, none, none};
  const auto vorticity = [&](const Field& kept) { return errors_of(still, kept).vorticity.max_abs; };
  EXPECT_DOUBLE_EQ(vorticity({none, z, y}), 0);  // dw/dy - dv/dz
  EXPECT_DOUBLE_EQ(vorticity({z, none, x}), 0);  // du/dz - dw/dx
  EXPECT_DOUBLE_EQ(vorticity({y, x, none}), 0);  // dv/dx - du/dy
  EXPECT_DOUBLE_EQ(vorticity({none, none, y}), 1);
  EXPECT_DOUBLE_EQ(vorticity({z, none, none}), 1);
  EXPECT_DOUBLE_EQ(vorticity({z, x, y}), std::sqrt(3.0));
}

TEST(VectorErrors, DependNeitherOnBlocksNorOnValuesThatAreNotFinite) {
  Field waves{[](const Index3& i) { return std::sin(x(i) + y(i)); }, [](const Index3& i) { return std::cos(z(i)); },
              [](const Index3& i) { return std::sin(x(i) * 0.1 * z(i)); }};
  const Field kept{[](const Index3& i) { return std::sin(x(i) + y(i)) + 0.01 * static_cast<double>(i.x % 3); },
                   waves[1], [](const Index3& i) { return std::sin(x(i) * 0.1 * z(i)) * 0.99; }};
  const Component second = waves[1];
  waves[1] = [=](const Index3& i) {
    return i == Index3{0, 10, -10} ? std::numeric_limits<double>::quiet_NaN() : second(i);
  };
  const VectorErrors whole = errors_of(waves, kept);
  EXPECT_EQ(whole.left_out, 6U);
  CompareOptions small;
  small.block_bytes = 16384;
  const VectorErrors pieces = errors_of(waves, kept, small);
  EXPECT_EQ(whole.vorticity.rms, pieces.vorticity.rms);
  EXPECT_EQ(whole.vorticity.max_abs, pieces.vorticity.max_abs);
  EXPECT_EQ(whole.divergence.rms, pieces.divergence.rms);
  EXPECT_EQ(whole.divergence.source_rms, pieces.divergence.source_rms);
  EXPECT_GT(whole.divergence.rms, 0);
}

TEST(VectorErrors, ComponentsOfDifferentFieldsAreRefused) {
  test::MemoryVolume small = volume_of(none, {{0, 0, 0}, {8, 8, 8}});
  test::MemoryVolume large = volume_of(none, {{0, 0, 0}, {8, 8, 9}});
  large.info().path = "other.raw";
  test::MemoryVolume stretched = volume_of(none, {{0, 0, 0}, {8, 8, 8}});
  stretched.info().spacing = {1, 1, 1};
  ConversionOptions lossless;
  lossless.budget.kind = Budget::Kind::lossless;
  const test::Converted file = test::convert(small, lossless);
  const NvdbGrid grid = file.grid();
  const auto message = [&](test::MemoryVolume& third) {
    try {
      vector_errors({{{small, grid}, {small, grid}, {third, grid}}}, {});
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message(large).substr(0, 27), "other.raw: holds the voxels");
  EXPECT_EQ(message(stretched),
            "in.raw: has the spacing 1,1,1, in.raw has 0.5,0.5,2; give the three components of one field");
}

}  // namespace
}  // namespace weir::vector_error_test
