// Volumes with all or some values kept in memory between the two passes. The file is, byte for byte, the file of a
// conversion that reads both times.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "format/process/process_memory.h"
#include "tests/compressor/support/budget_of.h"
#include "tests/compressor/support/converted.h"

namespace weir::kept_values_test {
namespace {

using test::Converted;
using test::MemoryVolume;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;
constexpr std::uint64_t kDense = std::uint64_t{150} * 131 * 203 * sizeof(float);

/// Returns a ball with waves in it and nothing around it.
MemoryVolume ball() {
  return {Box{{-5, 3, 40}, {145, 134, 243}}, [](const Index3& i) {
            const double x = static_cast<double>(i.x) - 70;
            const double y = static_cast<double>(i.y) - 60;
            const double z = static_cast<double>(i.z) - 140;
            const double radius = std::sqrt(x * x + y * y + z * z) / 100;
            return radius > 1 ? 0.0F
                              : static_cast<float>((1 - radius) * (1 + 0.3 * std::sin(0.2 * x) * std::cos(0.13 * z)));
          }};
}

/// The same volume as a source in memory. Reading it waits for nothing, so no values are kept.
class InMemory final : public VolumeSource {
 public:
  explicit InMemory(VolumeSource& source) : source_(source) {}
  const SourceInfo& info() const override { return source_.info(); }
  AccessShape access() const override { return source_.access(); }
  ConversionLoss read(const Box& box, std::span<float> values) override { return source_.read(box, values); }
  bool in_memory() const override { return true; }
  std::uint64_t bytes_read() const override { return source_.bytes_read(); }

 private:
  VolumeSource& source_;
};

class KeptValues : public testing::TestWithParam<std::tuple<Encoding, Budget>> {
 protected:
  ConversionOptions options() const {
    ConversionOptions options;
    std::tie(options.encoding, options.budget) = GetParam();
    options.threads = 2;
    return options;
  }
};

TEST_P(KeptValues, MakeTheSameFileAndAreReadOnce) {
  MemoryVolume volume = ball();
  InMemory in_memory(volume);
  const Converted expected = test::convert(in_memory, options());
  EXPECT_GT(volume.bytes_read(), kDense * 5 / 4);

  MemoryVolume again = ball();
  const Converted all = test::convert(again, options());
  EXPECT_EQ(again.bytes_read(), kDense);
  EXPECT_TRUE(all.file == expected.file);

  MemoryVolume third = ball();
  ConversionOptions some = options();
  some.memory = resident_bytes() + 72 * kMiB;
  const Converted part = test::convert(third, some);
  EXPECT_GT(third.bytes_read(), kDense);
  EXPECT_TRUE(part.file == expected.file);
}

TEST(KeptValuesOfMaskedData, BlocksOfOneNaNTakeNoRoom) {
  MemoryVolume volume(Box{{0, 0, 0}, {200, 160, 200}}, [](const Index3& i) {
    if (i.x > 80 || i.y > 80 || i.z > 80) return std::numeric_limits<float>::quiet_NaN();
    return static_cast<float>(std::sin(0.1 * static_cast<double>(i.x + i.y * i.z)));
  });
  ConversionOptions options;
  options.threads = 2;
  options.budget = {};
  options.budget.kind = Budget::Kind::rate;
  options.budget.rate = 4;
  options.non_finite = NonFinitePolicy::background;
  options.memory = resident_bytes() + 72 * kMiB;  // room for about 6 MiB of values
  test::convert(volume, options);
  EXPECT_EQ(volume.bytes_read(), std::uint64_t{200} * 160 * 200 * sizeof(float));
}

INSTANTIATE_TEST_SUITE_P(Encodings, KeptValues,
                         testing::Values(std::tuple(Encoding::packed, budget_of(Budget::Kind::rate, 16)),
                                         std::tuple(Encoding::packed, budget_of(Budget::Kind::max_error, 0.001)),
                                         std::tuple(Encoding::float32, budget_of(Budget::Kind::lossless, 0)),
                                         std::tuple(Encoding::fpn, budget_of(Budget::Kind::psnr, 50))));

}  // namespace
}  // namespace weir::kept_values_test
