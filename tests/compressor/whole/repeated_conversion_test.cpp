// Volumes from a source that knows which voxels repeat each other. The file is, byte for byte, the file of the same
// values from a source that does not know it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "ingest/source_registry.h"
#include "tests/compressor/support/converted.h"
#include "tests/support/plotfile_writer.h"
#include "tests/support/temporary_directory.h"

namespace weir::repeated_conversion_test {
namespace {

using test::Converted;
using test::MemoryVolume;
using test::PlotfilePlan;

/// Returns values that depend on the seed: smooth, on a lattice, all the same, or some of them not finite.
test::PlotfileValue value_of(std::uint64_t seed) {
  return [seed](std::size_t level, std::size_t /*component*/, const Index3& cell) {
    const double phase = 0.31 * static_cast<double>(cell.x) + 0.17 * static_cast<double>(cell.y * cell.z);
    if (seed % 5 == 1) return std::floor(4 * std::sin(phase));
    if (seed % 5 == 2 && level == 0) return -0.0;
    if (seed % 5 == 3 && (cell.x + cell.y) % 7 == 0) return std::numeric_limits<double>::quiet_NaN();
    return std::sin(phase) * std::exp(static_cast<double>(level) - 0.1 * static_cast<double>(cell.z));
  };
}

struct Wanted {
  Encoding encoding;
  Budget::Kind kind;
  double value;
};

const std::vector<Wanted> kWanted{
    {Encoding::automatic, Budget::Kind::rate, 8},     {Encoding::fpn, Budget::Kind::rate, 3},
    {Encoding::fp4, Budget::Kind::automatic, 0},      {Encoding::fp16, Budget::Kind::psnr, 50},
    {Encoding::float32, Budget::Kind::lossless, 0},   {Encoding::fpn, Budget::Kind::max_error, 0.01},
    {Encoding::automatic, Budget::Kind::psnr, 60},    {Encoding::packed, Budget::Kind::rate, 16},
    {Encoding::packed, Budget::Kind::lossless, 0},    {Encoding::packed, Budget::Kind::psnr, 70},
    {Encoding::automatic, Budget::Kind::automatic, 0}};

ConversionOptions options_for(const Wanted& wanted) {
  ConversionOptions options;
  options.encoding = wanted.encoding;
  options.budget.kind = wanted.kind;
  if (wanted.kind == Budget::Kind::rate) options.budget.rate = wanted.value;
  if (wanted.kind != Budget::Kind::rate) options.budget.target = wanted.value;
  options.non_finite = NonFinitePolicy::background;
  options.threads = 2;
  return options;
}

/// Returns the file and its source digest, or the error message if there is no file.
std::pair<std::vector<std::byte>, std::string> outcome(VolumeSource& source, const ConversionOptions& options) {
  try {
    const Converted converted = test::convert(source, options);
    return {converted.file, converted.sidecar.source.digest};
  } catch (const Error& error) {
    return {{}, error.what()};
  }
}

TEST(RepeatedConversion, FilesOfComposites_AreThoseOfTheSameValues) {
  int files = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const TemporaryDirectory directory;
    PlotfilePlan plan = test::generated_plotfile(seed);
    plan.value = value_of(seed);
    const std::string path = directory / "plt00042";
    test::write_plotfile(path, plan);
    SourceOptions source_options;
    source_options.dataset = "Temp";
    const auto source = open_source(path, source_options);
    MemoryVolume plain(*source);
    plain.info() = source->info();
    for (std::size_t i = seed % 3; i < kWanted.size(); i += 3) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", options " << i);
      const auto expected = outcome(plain, options_for(kWanted[i]));
      const auto found = outcome(*source, options_for(kWanted[i]));
      ASSERT_EQ(found.second, expected.second);
      ASSERT_TRUE(found.first == expected.first);
      files += found.first.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(files, 30);
}

}  // namespace
}  // namespace weir::repeated_conversion_test
