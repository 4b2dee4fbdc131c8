// A conversion of an array in memory gives the same bytes as a conversion of a raw file with the same values.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <span>
#include <vector>

#include "ingest/raw/raw_source.h"
#include "ingest/values/array_source.h"
#include "tests/compressor/support/converted.h"
#include "tests/support/temporary_directory.h"

namespace weir::array_conversion_test {
namespace {

const Index3 kExtent{150, 37, 29};

// Returns a volume: half is empty, half is a pattern with a peak, one value that no float32 holds, and one that means
// "no data".
std::vector<std::int32_t> pattern() {
  std::vector<std::int32_t> values(static_cast<std::size_t>(volume(kExtent)));
  for_each_index({{}, kExtent}, [&](const Index3& i) {
    const std::int64_t v = i.x < 75 ? 0 : (i.x * i.y * 7 + i.z * i.z * 13) % 1009;
    values[static_cast<std::size_t>(linear_index(i, kExtent))] = static_cast<std::int32_t>(v);
  });
  values[100] = (1 << 24) + 1;
  values[5000] = -1;
  return values;
}

test::Converted of_raw_file(const std::vector<std::int32_t>& values, const ConversionOptions& options) {
  const TemporaryDirectory directory;
  const std::string path = directory / "v.raw";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(std::span(values).size_bytes()));
  SourceOptions source;
  source.extent = kExtent;
  source.type = ScalarType::int32;
  source.missing = StoredValue{std::int64_t{-1}};
  const auto raw = open_raw(path, source);
  return test::convert(*raw, options);
}

class ArrayConversion : public testing::TestWithParam<Budget::Kind> {};

TEST_P(ArrayConversion, HasTheBytesOfTheRawFiles) {
  const std::vector<std::int32_t> values = pattern();
  std::vector<std::int32_t> transposed(values.size());  // z fastest
  for_each_index({{}, kExtent}, [&](const Index3& i) {
    transposed[static_cast<std::size_t>(i.z + kExtent.z * (i.y + kExtent.y * i.x))] =
        values[static_cast<std::size_t>(linear_index(i, kExtent))];
  });
  ConversionOptions options;
  options.budget.kind = GetParam();
  options.encoding = Encoding::automatic;
  options.missing = MissingPolicy::background;
  const test::Converted raw = of_raw_file(values, options);

  DenseArray packed{.data = values.data(), .type = ScalarType::int32, .extent = kExtent};
  packed.stride = packed_stride(kExtent, packed.type);
  packed.missing = {StoredValue{std::int64_t{-1}}};
  DenseArray c = packed;
  c.data = transposed.data();
  c.stride = {4 * kExtent.z * kExtent.y, 4 * kExtent.z, 4};
  for (const DenseArray& array : {packed, c}) {
    const auto source = open_array(array);
    const test::Converted converted = test::convert(*source, options);
    EXPECT_TRUE(converted.file == raw.file);
    EXPECT_EQ(converted.sidecar.source.digest, raw.sidecar.source.digest);
    EXPECT_EQ(converted.sidecar.source.format, "memory");
    EXPECT_EQ(converted.sidecar.source.bytes, raw.sidecar.source.bytes);
    EXPECT_EQ(converted.sidecar.conversion_loss.inexact, 1U);
    EXPECT_EQ(converted.sidecar.missing.count, 1U);
  }
}

INSTANTIATE_TEST_SUITE_P(Budgets, ArrayConversion, testing::Values(Budget::Kind::automatic, Budget::Kind::lossless));

}  // namespace
}  // namespace weir::array_conversion_test
