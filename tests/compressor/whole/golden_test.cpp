// The same input and options give the same file for any number of threads, memory ceiling and kind of reading, today
// and in a year. If a digest changes, the format or the selection has changed. Make such a change only on purpose.
#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include "compressor/conversion.h"
#include "format/base/error.h"
#include "format/io/digest.h"
#include "ingest/source_registry.h"
#include "ingest/synthetic/synthetic.h"
#include "tests/support/temporary_directory.h"

namespace weir::golden_test {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

struct Golden {
  const char* kind;
  Index3 extent;
  Budget budget;
  Metric metric;
  FillMode fill;
  NonFinitePolicy non_finite;
  const char* digest;
  Encoding encoding = Encoding::float32;
};

std::string name_of(const ::testing::TestParamInfo<Golden>& info) {
  std::string name = std::string(info.param.kind) + "_" + std::to_string(info.index);
  for (char& c : name) c = c == '-' ? '_' : c;
  return name;
}

class GoldenTest : public ::testing::TestWithParam<Golden> {
 protected:
  void SetUp() override {
    const auto source = open_synthetic(GetParam().kind, {GetParam().extent, 1});
    std::vector<float> values(static_cast<std::size_t>(volume(GetParam().extent)));
    source->read(source->info().domain(), values);
    std::ofstream file(input(), std::ios::binary);
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(float)));
  }

  std::string input() const { return directory_ / "in.raw"; }

  std::string convert(std::size_t threads, std::uint64_t memory, DirectIo direct_io) const {
    const Golden& golden = GetParam();
    SourceOptions source_options;
    source_options.extent = golden.extent;
    source_options.type = ScalarType::float32;
    source_options.direct_io = direct_io;
    const auto source = open_source(input(), source_options);
    ConversionOptions options;
    options.output = directory_ / "out.nvdb";
    options.overwrite = true;
    options.budget = golden.budget;
    options.encoding = golden.encoding;
    options.metric = golden.metric;
    options.fill = golden.fill;
    options.non_finite = golden.non_finite;
    options.threads = threads;
    options.memory = memory;
    const auto files = make_posix_file_system();
    const Sidecar sidecar = convert_volume(*source, options, {}, *files);
    // The sidecar's figures equal those of the file, read back by other means.
    std::ifstream file(options.output, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    EXPECT_EQ(bytes.size(), sidecar.file.bytes);
    std::vector<Digest> pieces;
    for (std::uint64_t i = 0; i < piece_count(bytes.size()); ++i) {
      pieces.push_back(piece_digest(file_piece(std::as_bytes(std::span(bytes)), i)));
    }
    EXPECT_EQ(combine(pieces).hex(), sidecar.file.digest);
    return sidecar.file.digest;
  }

  TemporaryDirectory directory_;
};

TEST_P(GoldenTest, DigestDoesNotDependOnThreadsMemoryOrReading) {
  const std::string expected = GetParam().digest;
  for (const std::size_t threads : {1U, 2U, 3U, 4U, 7U}) {
    EXPECT_EQ(convert(threads, 384 * kMiB, DirectIo::automatic), expected) << threads << " threads";
  }
  EXPECT_EQ(convert(2, 3072 * kMiB, DirectIo::automatic), expected);
  EXPECT_EQ(convert(2, 384 * kMiB, DirectIo::off), expected);
  try {
    EXPECT_EQ(convert(2, 384 * kMiB, DirectIo::on), expected);
  } catch (const Error& error) {
    // The directory for temporary files lies on a file system without direct I/O.
    EXPECT_EQ(error.kind(), ErrorKind::usage) << error.what();
  }
}

constexpr Budget kRate8{Budget::Kind::rate, 8, 0};
constexpr Budget kRate20{Budget::Kind::rate, 20, 0};
constexpr Budget kRate3{Budget::Kind::rate, 3, 0};
constexpr Budget kOdd{Budget::Kind::size, 8, 1234567};
constexpr Budget kLossless{Budget::Kind::lossless, 8, 0};

INSTANTIATE_TEST_SUITE_P(Volumes, GoldenTest,
                         ::testing::Values(Golden{"cloud",
                                                  {300, 200, 150},
                                                  kRate8,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "f59e459cfd2f650abf97b53b664df898"},
                                           Golden{"turbulence",
                                                  {131, 140, 135},
                                                  kRate3,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "39ec1765af63d79f9e777e26531965be"},
                                           Golden{"noise",
                                                  {131, 140, 17},
                                                  kOdd,
                                                  Metric::farthest,
                                                  FillMode::background,
                                                  NonFinitePolicy::error,
                                                  "1e10599919130f6c007b520be9ad8950"},
                                           Golden{"checkerboard",
                                                  {129, 129, 129},
                                                  kOdd,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "dd2a1d786be5bab4ff21fda2b6d3f0a1"},
                                           Golden{"sphere",
                                                  {200, 100, 140},
                                                  kLossless,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "034b8cc00c8b17ce35163939efbb823d"},
                                           Golden{"some-nan",
                                                  {100, 100, 100},
                                                  kRate3,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::background,
                                                  "20d763e9eda84dfd26296f6c27954d87"},
                                           Golden{"gradient",
                                                  {4100, 9, 10},
                                                  kLossless,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "02f48b189bdd0a7f62ee1fbe788a667b"},
                                           Golden{"cloud",
                                                  {300, 200, 150},
                                                  kRate8,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "7a4d9477e17ad72e443533803bf2fc2b",
                                                  Encoding::automatic},
                                           Golden{"turbulence",
                                                  {131, 140, 135},
                                                  kRate3,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "8e1a3484dfaa0a678b976f8ec7f67b71",
                                                  Encoding::fpn},
                                           Golden{"some-nan",
                                                  {100, 100, 100},
                                                  kOdd,
                                                  Metric::sse,
                                                  FillMode::background,
                                                  NonFinitePolicy::background,
                                                  "be7bd51828eb6b957af5f1395ea06764",
                                                  Encoding::fpn},
                                           Golden{"offset",
                                                  {100, 101, 102},
                                                  kLossless,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "6687003b90dd97a522c4ad4de17f7a9b",
                                                  Encoding::automatic},
                                           Golden{"noise",
                                                  {131, 140, 17},
                                                  kRate3,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "d0cd170d3942e6bdc3944d84b3f69bf7",
                                                  Encoding::fp4},
                                           Golden{"cloud",
                                                  {300, 200, 150},
                                                  kRate20,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "2e9b720f6ad1fefa934edf6a1bd5e62e",
                                                  Encoding::packed},
                                           Golden{"turbulence",
                                                  {131, 140, 135},
                                                  kRate20,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "5a7e4172f8e4eea16e91d909074d0c07",
                                                  Encoding::packed},
                                           Golden{"some-nan",
                                                  {131, 140, 135},
                                                  kRate3,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::background,
                                                  "bf6280f0f72eed59ebf2ac57507ae768",
                                                  Encoding::packed},
                                           Golden{"offset",
                                                  {100, 101, 102},
                                                  kLossless,
                                                  Metric::sse,
                                                  FillMode::mean,
                                                  NonFinitePolicy::error,
                                                  "12228c96894222b0dfdd5b42998f99f8",
                                                  Encoding::packed}),
                         name_of);

}  // namespace
}  // namespace weir::golden_test
