// Volumes in which some voxels have no value at all (ValueMapping::gaps). These voxels are inactive, read the
// background and count in no figure, also for stock NanoVDB.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "compressor/conversion.h"
#include "format/leaf/leaf_codec.h"
#include "ingest/source/stored_value.h"
#include "tests/compressor/support/converted.h"
#include "tests/compressor/support/measured.h"
#include "tests/stock/stock_tree.h"

namespace weir::gaps_test {
namespace {

using test::bits_of;
using test::Converted;
using test::MemoryVolume;

/// Returns whether a voxel lies in a gap. Gaps are a corner of the domain, a box that begins and ends inside blocks, a
/// box of whole blocks, and a whole region of 128^3.
bool in_gap(const Index3& i) {
  const Box boxes[] = {{{-140, -9, 3}, {-133, 0, 11}},
                       {{3, 5, 12}, {21, 18, 30}},
                       {{-64, 0, 16}, {-32, 16, 32}},
                       {{128, -9, 3}, {256, 40, 60}}};
  return std::any_of(std::begin(boxes), std::end(boxes), [&](const Box& box) { return box.contains(i); });
}

constexpr Box kDomain{{-140, -9, 3}, {261, 40, 45}};

float value_at(const Index3& i) {
  return std::sin(0.11F * static_cast<float>(i.x)) + 0.05F * static_cast<float>(i.y) + 0.01F * static_cast<float>(i.z);
}

MemoryVolume volume_with_gaps() {
  MemoryVolume volume(kDomain, [](const Index3& i) { return in_gap(i) ? missing_value() : value_at(i); });
  volume.info().mapping.gaps = true;
  return volume;
}

std::uint64_t gap_voxels() {
  std::uint64_t count = 0;
  for_each_index(kDomain, [&](const Index3& i) { count += in_gap(i) ? 1 : 0; });
  return count;
}

ConversionOptions options_for(Encoding encoding, FillMode fill) {
  ConversionOptions options;
  options.encoding = encoding;
  options.fill = fill;
  options.missing = MissingPolicy::background;
  options.background = -7.5F;  // far from all values
  return options;
}

bool is_pinned(const Index3& i) { return i == kDomain.lo || i == kDomain.hi - Index3{1, 1, 1}; }

/// Checks every voxel. A gap is inactive and reads the background. A voxel with a value is active, unless its block is
/// a tile of the background.
void expect_gaps(const Converted& converted, FillMode fill, bool exact_background) {
  const NvdbGrid grid = converted.grid();
  const test::StockReader stock(converted.file);
  ASSERT_TRUE(stock.valid());
  EXPECT_EQ(stock.index_bbox(), kDomain);
  for_each_index(kDomain, [&](const Index3& i) {
    const GridBlock block = grid.block_at(i);
    if (in_gap(i)) {
      EXPECT_EQ(stock.active(i), is_pinned(i)) << i.x << ' ' << i.y << ' ' << i.z;
      if (exact_background || block.leaf == nullptr) {
        EXPECT_EQ(stock.value(i), -7.5F);
      }
    } else if (block.leaf != nullptr || fill == FillMode::mean) {
      EXPECT_TRUE(stock.active(i)) << i.x << ' ' << i.y << ' ' << i.z;
    }
  });
}

TEST(Gaps, AreInactiveAndReadTheBackground_AtEverySizeAndFill) {
  MemoryVolume volume = volume_with_gaps();
  for (const FillMode fill : {FillMode::mean, FillMode::background}) {
    const ConversionOptions options = options_for(Encoding::float32, fill);
    const std::uint64_t minimum = test::minimum_size(volume, options);
    for (const std::uint64_t more : {0U, 500'000U, 20'000'000U}) {
      SCOPED_TRACE(fill_name(fill) + " " + std::to_string(more));
      const Converted converted = test::convert_to(volume, options, minimum + more);
      expect_gaps(converted, fill, true);
      EXPECT_EQ(converted.sidecar.missing.count, gap_voxels());
      EXPECT_EQ(converted.sidecar.missing.policy, "background");
      EXPECT_EQ(converted.sidecar.missing.values, std::vector<std::string>{});
      EXPECT_EQ(converted.sidecar.error.lossless, more == 20'000'000U);
    }
  }
}

/// The statistics of all nodes equal those that stock NanoVDB computes from the active voxels.
TEST(Gaps, StatisticsAreThoseOfTheActiveVoxels) {
  MemoryVolume volume = volume_with_gaps();
  ConversionOptions options = options_for(Encoding::float32, FillMode::mean);
  options.budget.kind = Budget::Kind::lossless;
  const Converted converted = test::convert(volume, options);
  const test::StockReader stock(converted.file);
  EXPECT_EQ(converted.grid().active_voxels(), stock.active_voxels());
  std::uint64_t active = 0;
  for_each_index(kDomain, [&](const Index3& i) { active += stock.active(i) ? 1 : 0; });
  EXPECT_EQ(active, stock.active_voxels());
  const std::vector<std::byte> ours = stock.grid();
  const std::vector<std::byte> theirs = stock.grid_with_stock_statistics();
  ASSERT_EQ(ours.size(), theirs.size());
  EXPECT_EQ(std::mismatch(ours.begin(), ours.end(), theirs.begin()).first - ours.begin(), std::ssize(ours));
  EXPECT_EQ(converted.grid().value_min(), -7.5F);  // the value of the pinned voxel
}

/// Blocks at the edge of a gap are kept, so that the file's error counts only their voxels with values.
TEST(Gaps, CountInNoFigureOfTheCertificate) {
  MemoryVolume volume = volume_with_gaps();
  for (const Encoding encoding : {Encoding::float32, Encoding::fpn, Encoding::automatic}) {
    SCOPED_TRACE(encoding_name(encoding));
    ConversionOptions options = options_for(encoding, FillMode::mean);
    const Converted converted = test::convert_to(volume, options, test::minimum_size(volume, options) + 40'000);
    test::expect_certificate(converted, test::measure(volume, converted, NonFinitePolicy::background));
    EXPECT_FALSE(converted.sidecar.error.lossless);
    expect_gaps(converted, FillMode::mean, encoding == Encoding::float32);
  }
}

TEST(Gaps, APackedFilesTreeHasInactiveTilesWhereNoVoxelHasAValue) {
  MemoryVolume volume = volume_with_gaps();
  ConversionOptions options = options_for(Encoding::packed, FillMode::mean);
  options.preview = Preview::on;
  options.budget.kind = Budget::Kind::lossless;
  const Converted converted = test::convert(volume, options);
  const test::StockReader stock(converted.file);
  EXPECT_FALSE(stock.active({-40, 8, 24}));
  EXPECT_EQ(stock.value({-40, 8, 24}), -7.5F);
  EXPECT_TRUE(stock.active({-20, 8, 24}));
  EXPECT_FALSE(stock.active({200, 8, 24}));
  const NvdbGrid grid = converted.grid();
  for_each_index(kDomain, [&](const Index3& i) {
    if (i.x % 3 != 0 || i.y % 5 != 0 || i.z % 7 != 0) return;  // each look-up decodes a block
    EXPECT_EQ(bits_of(grid.value(i)), bits_of(in_gap(i) ? -7.5F : value_at(i)));
  });
}

TEST(Gaps, AVolumeOfNothingElse_IsInactive) {
  MemoryVolume volume({{0, 0, 0}, {40, 40, 40}}, [](const Index3&) { return missing_value(); });
  volume.info().mapping.gaps = true;
  ConversionOptions options = options_for(Encoding::float32, FillMode::mean);
  options.background.reset();
  const Converted converted = test::convert(volume, options);
  const test::StockReader stock(converted.file);
  EXPECT_EQ(stock.active_voxels(), 2U);  // the corners
  EXPECT_EQ(stock.index_bbox(), (Box{{0, 0, 0}, {40, 40, 40}}));
  EXPECT_EQ(stock.value({20, 20, 20}), 0.0F);
  EXPECT_EQ(converted.sidecar.missing.count, 64'000U);
  EXPECT_TRUE(converted.sidecar.error.lossless);
}

/// Returns whether a voxel is stored as NaN: one voxel in a block of values, a whole block, the part of a block that a
/// gap leaves, and all in-domain voxels of a region.
bool is_stored_nan(const Index3& i) {
  const Box boxes[] = {{{50, 1, 20}, {51, 2, 21}},
                       {{80, 8, 16}, {88, 16, 24}},
                       {{-133, -9, 3}, {-128, 0, 11}},
                       {{256, -9, 3}, {261, 0, 45}}};
  return !in_gap(i) && std::any_of(std::begin(boxes), std::end(boxes), [&](const Box& box) { return box.contains(i); });
}

MemoryVolume volume_with_nan() {
  MemoryVolume volume(kDomain, [](const Index3& i) {
    return in_gap(i) ? missing_value() : is_stored_nan(i) ? std::nanf("") : value_at(i);
  });
  volume.info().mapping.gaps = true;
  return volume;
}

TEST(Gaps, StoredNaNThatReadsTheBackground_IsActiveWhateverItsBlockHolds) {
  MemoryVolume volume = volume_with_nan();
  for (const Encoding encoding : {Encoding::float32, Encoding::fpn}) {
    ConversionOptions options = options_for(encoding, FillMode::mean);
    options.non_finite = NonFinitePolicy::background;
    const std::uint64_t minimum = test::minimum_size(volume, options);
    for (const std::uint64_t more : {0U, 20'000'000U}) {
      SCOPED_TRACE(encoding_name(encoding) + " " + std::to_string(more));
      const Converted converted = test::convert_to(volume, options, minimum + more);
      expect_gaps(converted, FillMode::mean, encoding == Encoding::float32);
      const test::StockReader stock(converted.file);
      for_each_index(kDomain, [&](const Index3& i) {
        if (is_stored_nan(i) && encoding == Encoding::float32) {
          EXPECT_EQ(stock.value(i), -7.5F);
        }
      });
      EXPECT_EQ(converted.sidecar.missing.count, gap_voxels());
    }
  }
}

TEST(Gaps, APackedFilesTreeHasActiveTilesWhereNaNIsStored) {
  MemoryVolume volume = volume_with_nan();
  ConversionOptions options = options_for(Encoding::packed, FillMode::mean);
  options.non_finite = NonFinitePolicy::background;
  options.preview = Preview::on;
  options.budget.kind = Budget::Kind::lossless;
  const Converted converted = test::convert(volume, options);
  const test::StockReader stock(converted.file);
  EXPECT_TRUE(stock.active({84, 12, 20}));
  EXPECT_EQ(stock.value({84, 12, 20}), -7.5F);
  EXPECT_FALSE(stock.active({-40, 8, 24}));
}

/// NaN that the source stores is not taken for a gap. It is refused as in any other volume.
TEST(Gaps, StoredNaN_IsRefused) {
  MemoryVolume volume(kDomain, [](const Index3& i) {
    return in_gap(i) ? missing_value() : i == Index3{50, 1, 20} ? std::nanf("") : value_at(i);
  });
  volume.info().mapping.gaps = true;
  try {
    test::convert(volume, options_for(Encoding::float32, FillMode::mean));
    ADD_FAILURE() << "converted";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()),
              "memory: 1 voxel is NaN or infinite, the first (nan) at 50,1,20; choose --nonfinite background or "
              "--nonfinite keep");
  }
}

}  // namespace
}  // namespace weir::gaps_test
