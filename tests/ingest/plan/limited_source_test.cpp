#include "ingest/plan/limited_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace weir::limited_source_test {
namespace {

using namespace std::chrono_literals;

/// A source that reads four bytes per voxel. Opening it has read 100 bytes.
class CountingSource final : public VolumeSource {
 public:
  CountingSource() { info_.extent = {1000, 1, 1}; }
  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {4, {8, 8, 8}, {}}; }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    bytes_ += values.size_bytes();
    std::fill(values.begin(), values.end(), static_cast<float>(box.lo.x));
    return {1, 0, 0};
  }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override { return {{box, {2, 1, 1}}}; }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    return read(part.box, values);
  }
  bool in_memory() const override { return true; }
  std::uint64_t working_bytes() const override { return 17; }
  std::uint64_t bytes_read() const override { return bytes_; }

 private:
  SourceInfo info_;
  std::uint64_t bytes_ = 100;
};

TEST(LimitedSource, ReadsTheSameAndNoFasterThanAllowed) {
  const TokenBucket::Time start = TokenBucket::Time() + 1000h;
  TokenBucket::Time now = start;
  Bandwidth bandwidth(1000, nullptr, {[&] { return now; }, [&](auto time) { now += time; }});
  const auto source = limit_source(std::make_unique<CountingSource>(), bandwidth);
  EXPECT_EQ(source->info().extent.x, 1000);
  EXPECT_EQ(source->access().chunk.x, 8);
  EXPECT_TRUE(source->in_memory());
  EXPECT_EQ(source->working_bytes(), 17U);

  std::vector<float> values(50);
  EXPECT_EQ(source->read({{3, 0, 0}, {53, 1, 1}}, values).inexact, 1U);
  EXPECT_EQ(values, std::vector<float>(50, 3.0F));
  EXPECT_EQ(source->bytes_read(), 300U);
  EXPECT_EQ(now, start + 200ms);  // 100 of the 300 bytes, those of opening, are not limited
  source->read_alone({{3, 0, 0}, {53, 1, 1}}, values);
  EXPECT_EQ(now, start + 400ms);
  const std::vector<RepeatedPart> parts = source->repeated_parts({{0, 0, 0}, {50, 1, 1}});
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(source->read_repeated(parts[0], std::span(values).first(25)).inexact, 1U);
  EXPECT_EQ(now, start + 500ms);
}

}  // namespace
}  // namespace weir::limited_source_test
