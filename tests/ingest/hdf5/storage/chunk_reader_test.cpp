// Tests ChunkReader: boxes of chunked datasets with every filter, unwritten chunks, and damaged chunks.
#include "ingest/hdf5/storage/chunk_reader.h"

#include <zlib.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <ostream>
#include <vector>

#include "ingest/plan/block_plan.h"
#include "tests/ingest/hdf5/support/chunked_file.h"
#include "tests/ingest/support/scratch.h"

namespace weir::chunk_reader_test {
namespace {

constexpr std::uint64_t kMemory = std::uint64_t{512} << 20U;
constexpr float kFill = -7.0F;

std::vector<std::byte> bytes_of(float value) {
  const auto bytes = std::bit_cast<std::array<std::byte, 4>>(value);
  return {bytes.begin(), bytes.end()};
}

/// Returns smooth values with some noise. The values compress, but no two chunks are the same.
std::vector<float> field(std::size_t count) {
  std::vector<float> values(count);
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < count; ++i) {
    state = state * 1664525U + 1013904223U;
    values[i] = static_cast<float>(i / 7) + static_cast<float>(state >> 30U) * 0.25F;
  }
  return values;
}

ChunkedSlice slice_of(const ChunkedFile& file, std::vector<std::int64_t> index = {}) {
  ChunkedSlice slice;
  slice.dataset = file.dataset();
  slice.name = "run.h5: d";
  slice.index = std::move(index);
  slice.fill = bytes_of(kFill);
  return slice;
}

Box box_of(const Index3& extent) { return {{0, 0, 0}, extent}; }

std::vector<float> read(ChunkReader& reader, const Box& box) {
  std::vector<float> values(static_cast<std::size_t>(box.voxels()));
  reader.read(box, values);
  return values;
}

/// Returns the values in `box` of the volume `all`, which has `extent` voxels.
std::vector<float> part_of(const std::vector<float>& all, const Index3& extent, const Box& box) {
  std::vector<float> part;
  for (std::int64_t i = 0; i < box.voxels(); ++i) {
    part.push_back(all[static_cast<std::size_t>(linear_index(box.lo + index_at(i, box.extent()), extent))]);
  }
  return part;
}

struct FilterCase {
  std::string name;
  std::vector<H5Z_filter_t> filters;
};

std::ostream& operator<<(std::ostream& out, const FilterCase& c) { return out << c.name; }

class ChunkReaderFilters : public testing::TestWithParam<FilterCase> {};

TEST_P(ChunkReaderFilters, AnyBoxReadsBackWhatWasWritten) {
  const Scratch scratch;
  const Index3 extent{37, 29, 23};  // chunks overhang on every axis
  for (const H5F_libver_t oldest : {H5F_LIBVER_V18, H5F_LIBVER_V110}) {
    for (const bool partial_unfiltered : {false, true}) {
      if (partial_unfiltered && oldest == H5F_LIBVER_V18) continue;
      ChunkedFile file(scratch.path("f.h5"),
                       {{23, 29, 37}, {5, 8, 16}, GetParam().filters, partial_unfiltered, H5T_NATIVE_FLOAT, oldest});
      const std::vector<float> all = field(file.elements());
      file.write(H5T_NATIVE_FLOAT, all);
      file.reopen();
      ASSERT_TRUE(ChunkReader::decodes(file.dataset()));
      ChunkReader reader(slice_of(file), kMemory);
      EXPECT_EQ(reader.access().chunk, (Index3{16, 8, 5}));
      EXPECT_EQ(reader.access().bytes_per_voxel, 4U);

      EXPECT_EQ(read(reader, box_of(extent)), all);
      EXPECT_EQ(reader.counts().decoded, 3U * 4 * 5) << "each chunk once";
      EXPECT_EQ(reader.counts().unallocated, 0U);
      for (const Box& box :
           {Box{{0, 0, 0}, {1, 1, 1}}, Box{{36, 28, 22}, {37, 29, 23}}, Box{{15, 7, 4}, {17, 9, 6}},
            Box{{0, 3, 2}, {37, 20, 21}}, Box{{16, 8, 5}, {32, 16, 10}}, Box{{3, 0, 0}, {9, 29, 23}}}) {
        EXPECT_EQ(read(reader, box), part_of(all, extent, box));
      }
      EXPECT_EQ(reader.counts().decoded, 60U + 1 + 1 + 8 + 45 + 1 + 20);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ChunkReaderFilters,
                         testing::Values(FilterCase{"None", {}}, FilterCase{"Deflate", {H5Z_FILTER_DEFLATE}},
                                         FilterCase{"Shuffle", {H5Z_FILTER_SHUFFLE}},
                                         FilterCase{"Fletcher32", {H5Z_FILTER_FLETCHER32}},
                                         FilterCase{"ShuffleDeflate", {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}},
                                         FilterCase{"DeflateShuffle", {H5Z_FILTER_DEFLATE, H5Z_FILTER_SHUFFLE}},
                                         FilterCase{"ShuffleDeflateFletcher32",
                                                    {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32}},
                                         FilterCase{"Fletcher32ShuffleDeflate",
                                                    {H5Z_FILTER_FLETCHER32, H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}}),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(ChunkReader, GzipAndShuffle_ReadEachChunkOnce) {
  const Scratch scratch;
  const ChunkedFile file(scratch.path("f.h5"),
                         {{128, 256, 256}, {32, 64, 64}, {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}});
  const std::vector<float> all = field(file.elements());
  file.write(H5T_NATIVE_FLOAT, all);
  ChunkReader reader(slice_of(file), kMemory);
  EXPECT_EQ(read(reader, box_of({256, 256, 128})), all);
  EXPECT_EQ(reader.counts().decoded, 64U);
  EXPECT_LT(reader.counts().bytes_read, all.size() * sizeof(float));
  EXPECT_GT(reader.counts().bytes_read, 100'000U);
}

TEST(ChunkReader, APassOverTheBlocksOfAPlanDecodesEveryChunkOnce) {
  const Scratch scratch;
  const Index3 extent{200, 136, 100};
  for (const std::vector<hsize_t>& chunk :
       std::vector<std::vector<hsize_t>>{{32, 32, 32}, {1, 136, 200}, {10, 24, 64}}) {
    const ChunkedFile file(scratch.path("f.h5"), {{100, 136, 200}, chunk, {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}});
    const std::vector<float> all = field(file.elements());
    file.write(H5T_NATIVE_FLOAT, all);
    ChunkReader reader(slice_of(file), kMemory);
    const BlockPlan plan = plan_blocks(box_of(extent), reader.access(), std::uint64_t{4} << 20U);  // of 10 MiB
    EXPECT_GT(plan.size(), 1);
    EXPECT_EQ(plan.amplification, 1.0);
    for (std::int64_t i = 0; i < plan.size(); ++i) {
      const Box box = plan.voxel_box(plan.leaf_box(i));
      EXPECT_EQ(read(reader, box), part_of(all, extent, box));
    }
    std::uint64_t chunks = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      chunks *= (std::vector<hsize_t>{100, 136, 200}[axis] + chunk[axis] - 1) / chunk[axis];
    EXPECT_EQ(reader.counts().decoded, chunks);
  }
}

TEST(ChunkReader, SeveralReadsAtATime) {
  const Scratch scratch;
  const ChunkedFile file(scratch.path("f.h5"), {{64, 64, 64}, {16, 16, 16}, {H5Z_FILTER_DEFLATE}});
  const std::vector<float> all = field(file.elements());
  file.write(H5T_NATIVE_FLOAT, all);
  ChunkReader reader(slice_of(file), kMemory);
  std::vector<std::jthread> threads;
  for (std::int64_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      const Box box{{t, 2 * t, 3 * t}, {64 - t, 60, 61}};
      for (int turn = 0; turn < 5; ++turn) EXPECT_EQ(read(reader, box), part_of(all, {64, 64, 64}, box));
    });
  }
}

TEST(ChunkReader, ReadsLeadingAxesInsideAChunk) {
  const Scratch scratch;
  const ChunkedFile file(scratch.path("f.h5"),
                         {{5, 3, 6, 7, 8}, {2, 3, 4, 4, 4}, {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}});
  const std::vector<float> all = field(file.elements());
  file.write(H5T_NATIVE_FLOAT, all);
  for (const std::vector<std::int64_t>& index :
       std::vector<std::vector<std::int64_t>>{{0, 0}, {1, 2}, {3, 1}, {4, 2}}) {
    ChunkReader reader(slice_of(file, index), kMemory);
    const auto first = static_cast<std::ptrdiff_t>((index[0] * 3 + index[1]) * 6 * 7 * 8);
    EXPECT_EQ(read(reader, box_of({8, 7, 6})),
              (std::vector<float>(all.begin() + first, all.begin() + first + 6 * 7 * 8)));
    EXPECT_EQ(reader.access().chunk, (Index3{4, 4, 4}));
  }
}

TEST(ChunkReader, StoredTypesByteOrderAndMapping) {
  const Scratch scratch;
  const ChunkedFile file(scratch.path("f.h5"),
                         {{9, 10, 11}, {4, 4, 4}, {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}, false, H5T_STD_I16BE});
  std::vector<std::int16_t> stored(file.elements());
  std::vector<float> expected(stored.size());
  for (std::size_t i = 0; i < stored.size(); ++i) {
    stored[i] = static_cast<std::int16_t>(i * 65 - 30000);
    expected[i] = static_cast<float>(stored[i] * 0.5 + 3);
  }
  stored[100] = -9999;
  file.write(H5T_NATIVE_SHORT, stored);
  ChunkedSlice slice = slice_of(file);
  slice.type = ScalarType::int16;
  slice.big_endian = true;
  slice.mapping = {0.5, 3, {std::int64_t{-9999}}};
  slice.fill = {std::byte{0}, std::byte{0}};
  ChunkReader reader(slice, kMemory);
  std::vector<float> values = read(reader, box_of({11, 10, 9}));
  EXPECT_TRUE(is_missing(values[100]));
  values[100] = expected[100];
  EXPECT_EQ(values, expected);
}

TEST(ChunkReader, ConversionLossIsCountedOnceForEveryVoxel) {
  const Scratch scratch;
  ChunkedFile file(scratch.path("f.h5"), {{4, 4, 8}, {4, 4, 4}, {}, false, H5T_IEEE_F64LE});
  const double inexact = 1 + 0x1p-30;
  std::vector<std::byte> chunk(64 * sizeof inexact);
  for (std::size_t i = 0; i < 64; ++i) std::memcpy(&chunk[i * sizeof inexact], &inexact, sizeof inexact);
  file.write_chunk({0, 0, 4}, chunk);
  ChunkedSlice slice = slice_of(file);
  slice.type = ScalarType::float64;
  const auto fill = std::bit_cast<std::array<std::byte, 8>>(1e300);
  slice.fill = {fill.begin(), fill.end()};
  ChunkReader reader(slice, kMemory);
  std::vector<float> values(4 * 4 * 8);
  const ConversionLoss loss = reader.read(box_of({8, 4, 4}), values);
  EXPECT_EQ(loss.inexact, 64U);
  EXPECT_EQ(loss.overflow, 64U);
  EXPECT_EQ(loss.max_abs_error, 0x1p-30);
}

TEST(ChunkReader, ChunksNeverWrittenReadAsTheFillValue) {
  const Scratch scratch;
  for (const bool filtered : {false, true}) {
    ChunkedShape shape{{8, 8, 24}, {8, 8, 8}, {}};
    if (filtered) shape.filters = {H5Z_FILTER_DEFLATE};
    ChunkedFile file(scratch.path("f.h5"), shape);
    ChunkReader empty(slice_of(file), kMemory);
    EXPECT_EQ(read(empty, box_of({24, 8, 8})), std::vector<float>(24 * 64, kFill));
    EXPECT_EQ(empty.counts().unallocated, 3U);
    EXPECT_EQ(empty.counts().decoded, 0U);

    const std::vector<float> ones(512, 1.0F);
    file.write_chunk({0, 0, 8}, std::as_bytes(std::span(ones)), kAllLeftOut);
    file.reopen();
    ChunkReader reader(slice_of(file), kMemory);
    std::vector<float> values = read(reader, {{7, 0, 0}, {17, 1, 1}});
    EXPECT_EQ(values, (std::vector<float>{kFill, 1, 1, 1, 1, 1, 1, 1, 1, kFill}));
    EXPECT_EQ(reader.counts().unallocated, 2U);
    EXPECT_EQ(reader.counts().decoded, 1U);
    // If the fill value means no data, unwritten voxels are missing.
    ChunkedSlice slice = slice_of(file);
    slice.mapping.missing = {double{kFill}};
    ChunkReader missing(slice, kMemory);
    values = read(missing, {{7, 0, 0}, {9, 1, 1}});
    EXPECT_TRUE(is_missing(values[0]));
    EXPECT_EQ(values[1], 1.0F);
  }
}

// Tests of damaged chunks. Every message names the dataset and the chunk, and all other chunks stay readable.

std::string message_of_read(const ChunkedFile& file, const Box& box) {
  ChunkReader reader(slice_of(file), kMemory);
  return message_of_error(ErrorKind::input, [&] { read(reader, box); });
}

TEST(ChunkReader, RefusesDeflateBombsAndShortStreams) {
  const Scratch scratch;
  ChunkedFile file(scratch.path("f.h5"), {{8, 8, 16}, {8, 8, 8}, {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}});
  const auto deflated = [](std::size_t zeros) {
    const std::vector<Bytef> bytes(zeros);
    uLongf size = compressBound(zeros);
    std::vector<std::byte> stream(size);
    EXPECT_EQ(compress(reinterpret_cast<Bytef*>(stream.data()), &size, bytes.data(), zeros), Z_OK);
    stream.resize(size);
    return stream;
  };
  file.write_chunk({0, 0, 8}, deflated(std::size_t{1} << 20U));
  EXPECT_EQ(message_of_read(file, box_of({16, 8, 8})),
            "run.h5: d: chunk at 0, 0, 8: its deflate stream holds more than 2048 bytes; the file is damaged");
  file.write_chunk({0, 0, 8}, deflated(2047));
  EXPECT_EQ(message_of_read(file, box_of({16, 8, 8})),
            "run.h5: d: chunk at 0, 0, 8: its deflate stream ends after 2047 of 2048 bytes; the file is damaged");
  file.write_chunk({0, 0, 8}, std::vector<std::byte>(100, std::byte{0xFF}));
  EXPECT_EQ(message_of_read(file, box_of({16, 8, 8})),
            "run.h5: d: chunk at 0, 0, 8: its deflate stream is damaged after 0 of 2048 bytes (incorrect header "
            "check); the file is damaged");
  file.write_chunk({0, 0, 8}, std::vector<std::byte>(5000));
  EXPECT_EQ(message_of_read(file, box_of({16, 8, 8})),
            "run.h5: d: chunk at 0, 0, 8: takes 5000 bytes, and at most 2120 can be right; the file is damaged");
  // The undamaged chunk at 0, 0, 0 can still be read.
  ChunkReader reader(slice_of(file), kMemory);
  EXPECT_EQ(read(reader, box_of({8, 8, 8})), std::vector<float>(512, kFill));
}

TEST(ChunkReader, RefusesWrongSizesAndChecksums) {
  const Scratch scratch;
  ChunkedFile file(scratch.path("f.h5"), {{8, 8, 8}, {8, 8, 8}, {H5Z_FILTER_SHUFFLE, H5Z_FILTER_FLETCHER32}});
  file.write(H5T_NATIVE_FLOAT, field(512));
  file.reopen();
  EXPECT_EQ(read(*std::make_unique<ChunkReader>(slice_of(file), kMemory), box_of({8, 8, 8})), field(512));
  std::vector<std::byte> stored(2052);
  std::uint32_t left_out = 0;
  const std::vector<hsize_t> corner{0, 0, 0};
  ASSERT_GE(H5Dread_chunk(file.dataset(), H5P_DEFAULT, corner.data(), &left_out, stored.data()), 0);
  stored[1000] ^= std::byte{0x10};
  file.write_chunk(corner, stored);
  EXPECT_TRUE(std::string_view(message_of_read(file, box_of({8, 8, 8})))
                  .starts_with("run.h5: d: chunk at 0, 0, 0: its checksum is "));
  file.write_chunk(corner, std::span(stored).first(2047), kAllLeftOut);
  file.reopen();
  EXPECT_EQ(message_of_read(file, box_of({8, 8, 8})),
            "run.h5: d: chunk at 0, 0, 0: holds 2047 bytes, not 2048; the file is damaged");
}

TEST(ChunkReader, TruncatedFileIsReportedAsDamaged) {
  const Scratch scratch;
  ChunkedFile file(scratch.path("f.h5"), {{64, 32, 32}, {16, 16, 16}, {H5Z_FILTER_DEFLATE}});
  file.write(H5T_NATIVE_FLOAT, field(file.elements()));
  file.reopen();
  std::filesystem::resize_file(scratch.path("f.h5"), std::filesystem::file_size(scratch.path("f.h5")) / 2);
  // Beyond the end of the file, the library reads zeros and reports no error.
  const std::string message = message_of_read(file, box_of({32, 32, 64}));
  EXPECT_TRUE(std::string_view(message).starts_with("run.h5: d: chunk at ")) << message;
  EXPECT_TRUE(std::string_view(message).ends_with("; the file is damaged")) << message;
}

}  // namespace
}  // namespace weir::chunk_reader_test
