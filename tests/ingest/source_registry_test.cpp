#include "ingest/source_registry.h"

#include <cstdint>
#include <functional>
#include <map>
#include <numeric>

#include "tests/ingest/scratch.h"

namespace weir {
namespace {

constexpr Index3 kExtent{4, 3, 2};

/// A file of each format, all with the values 0 ... 23 in 4 x 3 x 2 voxels.
const std::map<std::string_view, std::function<std::string(const Scratch&)>> kSamples{
    {"raw", [](const Scratch& scratch) {
       std::vector<std::uint8_t> values(24);
       std::iota(values.begin(), values.end(), std::uint8_t{0});
       return scratch.write_values("sample_4x3x2_uint8.raw", values);
     }}};

TEST(SourceRegistry, OpensEveryFormat) {
  const Scratch scratch;
  std::vector<float> expected(24);
  std::iota(expected.begin(), expected.end(), 0.0F);
  for (const SourceFormat& format : source_formats()) {
    SCOPED_TRACE(format.name);
    ASSERT_TRUE(kSamples.contains(format.name)) << "no sample of this format in the test";
    const std::string path = kSamples.at(format.name)(scratch);
    const auto source = open_source(path, {});
    EXPECT_EQ(source->info().format, format.name);
    EXPECT_EQ(source->info().path, path);
    EXPECT_EQ(source->info().extent, kExtent);
    EXPECT_EQ(source->info().file_bytes, std::filesystem::file_size(path));
    std::vector<float> values(24);
    source->read(source->info().domain(), values);
    EXPECT_EQ(values, expected);

    SourceOptions options;
    options.roi = Box{{1, 1, 1}, {3, 2, 2}};
    options.spacing = {2.0, 3.0, 4.0};
    const auto part = open_source(path, options);
    EXPECT_EQ(part->info().index_origin, (Index3{1, 1, 1}));
    EXPECT_EQ(part->info().spacing, (std::array<double, 3>{2.0, 3.0, 4.0}));
    part->read(part->info().domain(), std::span(values).first(2));
    EXPECT_EQ(values[0], 17.0F);
    EXPECT_EQ(values[1], 18.0F);
  }
}

TEST(SourceRegistry, MissingFilesAreAnErrorOfTheInput) {
  const Scratch scratch;
  const std::string path = scratch.path("none_4x3x2_uint8.raw");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, {}); }),
            path + ": cannot open for reading: No such file or directory");
}

}  // namespace
}  // namespace weir
