#include "ingest/raw/stack_source.h"

#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <numeric>

#include "ingest/source_registry.h"
#include "tests/ingest/support/scratch.h"

namespace weir::stack_source_test {
namespace {

constexpr Index3 kExtent{6, 5, 40};

std::vector<std::uint16_t> ramp() {
  std::vector<std::uint16_t> values(static_cast<std::size_t>(volume(kExtent)));
  std::iota(values.begin(), values.end(), std::uint16_t{0});
  return values;
}

// Writes the ramp in slabs of `planes` planes, numbered from `first` on. The last slab may be shorter. Returns the path
// pattern of the slabs.
std::string write_slabs(const Scratch& scratch, std::int64_t planes, int first = 7) {
  const auto values = ramp();
  const std::int64_t plane = kExtent.x * kExtent.y;
  for (std::int64_t z = 0; z < kExtent.z; z += planes) {
    const std::int64_t count = std::min(planes, kExtent.z - z);
    const std::string name = "s_" + std::to_string(first++) + ".raw";
    scratch.write_values(name,
                         std::vector<std::uint16_t>(values.begin() + z * plane, values.begin() + (z + count) * plane));
  }
  return scratch.path("s_%d.raw");
}

SourceOptions slab_options(std::int64_t planes) {
  SourceOptions options;
  options.stack = true;
  options.extent = Index3{kExtent.x, kExtent.y, planes};
  options.type = ScalarType::uint16;
  return options;
}

std::vector<float> read(VolumeSource& source, const Box& box) {
  std::vector<float> values(static_cast<std::size_t>(box.voxels()), -1.0F);
  source.read(box, values);
  return values;
}

TEST(StackSource, ReadsItsFilesAsOneVolume) {
  const auto all = ramp();
  const std::vector<float> expected(all.begin(), all.end());
  for (const std::int64_t planes : {1, 4, 8, 20, 40}) {
    const Scratch scratch;
    const auto source = open_source(write_slabs(scratch, planes), slab_options(planes));
    EXPECT_EQ(source->info().format, "stack");
    EXPECT_EQ(source->info().extent, kExtent);
    EXPECT_EQ(source->info().type, ScalarType::uint16);
    EXPECT_EQ(source->info().file_bytes, 2 * all.size());
    EXPECT_EQ(read(*source, source->info().domain()), expected) << planes;
    EXPECT_EQ(source->bytes_read(), 2 * all.size());
    // A box that begins and ends inside slabs.
    const Box box{{1, 2, 3}, {5, 4, 38}};
    std::vector<float> part;
    for (std::int64_t z = 3; z < 38; ++z) {
      for (std::int64_t y = 2; y < 4; ++y) {
        for (std::int64_t x = 1; x < 5; ++x) part.push_back(static_cast<float>(x + 6 * (y + 5 * z)));
      }
    }
    EXPECT_EQ(read(*source, box), part) << planes;
  }
}

TEST(StackSource, ThousandsOfPlanesNeedFewDescriptors) {
  const Scratch scratch;
  for (int z = 0; z < 3000; ++z) {
    scratch.write_values("p_" + std::to_string(z) + "_2x1x1_uint16.raw",
                         std::vector<std::uint16_t>{static_cast<std::uint16_t>(z), 1});
  }
  SourceOptions options;
  options.stack = true;
  const auto source = open_source(scratch.path("p_%d_2x1x1_uint16.raw"), options);
  const auto values = read(*source, source->info().domain());
  for (std::size_t z = 0; z < 3000; ++z) ASSERT_EQ(values[2 * z], static_cast<float>(z));
}

TEST(StackSource, SmallFilesAreReadWhole) {
  const Scratch scratch;
  const auto source = open_source(write_slabs(scratch, 8), slab_options(8));
  EXPECT_EQ(source->access().chunk, (Index3{6, 5, 8}));
}

TEST(StackSource, PlacementAndRegionAreTheStacks) {
  const Scratch scratch;
  SourceOptions options = slab_options(4);
  options.spacing = {1, 2, 3};
  options.roi = Box{{0, 0, 2}, {6, 5, 12}};
  const auto source = open_source(write_slabs(scratch, 4), options);
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(source->info().index_origin, (Index3{0, 0, 2}));
  EXPECT_EQ(read(*source, {{0, 0, 2}, {2, 1, 3}}), (std::vector<float>{60, 61}));
}

TEST(StackSource, WithMissingChunks_IsRefusedForARegionToo) {
  const Scratch scratch;
  SourceOptions options = slab_options(4);
  options.roi = Box{{0, 0, 2}, {6, 5, 12}};
  options.missing_chunks = MissingChunks::error;
  const std::string stack = write_slabs(scratch, 4);
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(stack, options); }),
            scratch.path("s_7.raw") +
                ": --missing-chunks error is for Zarr arrays and HDF5 files, and this is raw; leave it out");
}

TEST(StackSource, RefusesHoles) {
  const auto refusal = [](const std::string& pattern, const SourceOptions& options) {
    return message_of_error(ErrorKind::input, [&] { open_source(pattern, options); });
  };
  const Scratch scratch;
  const std::string pattern = write_slabs(scratch, 4);
  std::filesystem::remove(scratch.path("s_9.raw"));
  EXPECT_EQ(refusal(pattern, slab_options(4)),
            pattern + ": number 9 is missing between 7 and 16; a stack has no holes");
}

TEST(StackSource, FileThatCannotBeRead_IsNoHole) {
  const Scratch scratch;
  const std::string pattern = write_slabs(scratch, 4);
  std::filesystem::remove(scratch.path("s_9.raw"));
  ASSERT_EQ(::mkfifo(scratch.path("s_9.raw").c_str(), 0600), 0);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(pattern, slab_options(4)); }),
            scratch.path("s_9.raw") + ": is not a regular file; copy its content to one");
}

}  // namespace
}  // namespace weir::stack_source_test
