#include "ingest/source/reversed_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "ingest/source/source_view.h"
#include "ingest/values/array_source.h"
#include "tests/ingest/support/telling_source.h"

namespace weir::reversed_source_test {
namespace {

constexpr Index3 kExtent{4, 3, 5};

class ReversedSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    for (std::size_t i = 0; i < stored_.size(); ++i) stored_[i] = static_cast<float>(i);
  }
  std::unique_ptr<VolumeSource> source() const {
    DenseArray array;
    array.data = stored_.data();
    array.extent = kExtent;
    array.stride = packed_stride(kExtent, ScalarType::float32);
    return open_array(array);
  }
  float at(const Index3& i) const { return stored_[static_cast<std::size_t>(linear_index(i, kExtent))]; }

  std::vector<float> stored_ = std::vector<float>(static_cast<std::size_t>(volume(kExtent)));
};

TEST_F(ReversedSourceTest, EveryBoxHasTheVoxelsFromTheOtherEnds) {
  for (unsigned axes = 0; axes < 8; ++axes) {
    const std::array<bool, 3> reversed{(axes & 1U) != 0, (axes & 2U) != 0, (axes & 4U) != 0};
    const auto view = reverse_axes(source(), reversed);
    for (const Box& box : {Box{{0, 0, 0}, kExtent}, Box{{1, 0, 2}, {3, 2, 5}}, Box{{3, 2, 4}, {4, 3, 5}}}) {
      std::vector<float> values(static_cast<std::size_t>(box.voxels()));
      view->read(box, values);
      std::vector<float> alone(values.size());
      view->read_alone(box, alone);
      EXPECT_EQ(alone, values);
      for (std::int64_t i = 0; i < box.voxels(); ++i) {
        Index3 voxel = box.lo + index_at(i, box.extent());
        if (reversed[0]) voxel.x = kExtent.x - 1 - voxel.x;
        if (reversed[1]) voxel.y = kExtent.y - 1 - voxel.y;
        if (reversed[2]) voxel.z = kExtent.z - 1 - voxel.z;
        EXPECT_EQ(values[static_cast<std::size_t>(i)], at(voxel)) << axes;
      }
    }
  }
}

TEST_F(ReversedSourceTest, WithoutAReversedAxisItIsTheSourceItself) {
  auto plain = source();
  const VolumeSource* const before = plain.get();
  EXPECT_EQ(reverse_axes(std::move(plain), {}).get(), before);
}

/// A source that says it is stored in chunks.
class ChunkedVolume final : public VolumeSource {
 public:
  explicit ChunkedVolume(std::unique_ptr<VolumeSource> source) : source_(std::move(source)) {}
  const SourceInfo& info() const override { return source_->info(); }
  AccessShape access() const override { return {4, {3, 2, 2}, {0, 0, 1}}; }
  ConversionLoss read(const Box& box, std::span<float> values) override { return source_->read(box, values); }
  std::uint64_t bytes_read() const override { return source_->bytes_read(); }

 private:
  std::unique_ptr<VolumeSource> source_;
};

TEST_F(ReversedSourceTest, ChunksEndWhereTheyBegan) {
  const auto view = reverse_axes(std::make_unique<ChunkedVolume>(source()), {true, false, true});
  EXPECT_EQ(view->access().chunk, (Index3{3, 2, 2}));
  EXPECT_EQ(view->access().chunk_origin, (Index3{4, 0, 4}));
}

TEST_F(ReversedSourceTest, VoxelsWithValues_LieAtTheOtherEnd) {
  Told told;
  const auto view = reverse_axes(std::make_unique<TellingSource>(told), {true, false, false});
  EXPECT_EQ(view->voxels_with_values({{0, 0, 0}, {16, 8, 8}}), (std::vector<Box>{{{8, 0, 0}, {16, 8, 8}}}));
  EXPECT_EQ(view->voxels_with_values({{2, 1, 1}, {6, 2, 2}}), (std::vector<Box>{{{4, 1, 1}, {6, 2, 2}}}));
  EXPECT_EQ(told.asked.back(), (Box{{10, 1, 1}, {14, 2, 2}}));
}

TEST_F(ReversedSourceTest, NothingRepeatsAndNothingIsHeld) {
  Told told;
  const auto view = reverse_axes(std::make_unique<TellingSource>(told), {true, false, false});
  const std::vector<RepeatedPart> parts = view->repeated_parts({{0, 0, 0}, {8, 8, 8}});
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_FALSE(parts[0].repeats());
  std::vector<float> values(512);
  view->read_repeated(parts[0], values);
  EXPECT_EQ(told.asked.back(), (Box{{8, 0, 0}, {16, 8, 8}}));
  EXPECT_EQ(view->resident(), nullptr);
  EXPECT_EQ(view->places(), nullptr);
  EXPECT_EQ(view->held({{0, 0, 0}, {8, 8, 8}}), nullptr);
}

TEST_F(ReversedSourceTest, RegionsCountInTheReversedVolume) {
  const auto part = crop_source(reverse_axes(source(), {false, true, false}), {{0, 0, 0}, {1, 1, 1}});
  std::vector<float> value(1);
  part->read(part->info().domain(), value);
  EXPECT_EQ(value[0], at({0, kExtent.y - 1, 0}));
}

}  // namespace
}  // namespace weir::reversed_source_test
