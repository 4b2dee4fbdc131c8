#include "tools/sweep/zfp_codec.h"

#include <gtest/gtest.h>
#include <zfp.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace weir::zfp_codec_test {
namespace {

std::vector<float> waves(const Index3& extent) {
  std::vector<float> values(static_cast<std::size_t>(volume(extent)));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Index3 at = index_at(static_cast<std::int64_t>(i), extent);
    values[i] = static_cast<float>(std::sin(0.3 * static_cast<double>(at.x)) + 0.1 * static_cast<double>(at.y) +
                                   std::cos(0.7 * static_cast<double>(at.z)));
  }
  return values;
}

TEST(ZfpCodec, StreamSizeIsTheBitsOfAllBlocksInWholeWords) {
  const std::uint64_t word = stream_word_bits / 8;
  EXPECT_EQ(zfp_stream_bytes({8, 8, 8}, 64), 64U);
  EXPECT_EQ(zfp_stream_bytes({9, 5, 1}, 64), 6 * 8U);  // 3 x 2 x 1 blocks
  EXPECT_EQ(zfp_stream_bytes({4, 4, 4}, 9), (9 + 8 * word - 1) / (8 * word) * word);
  EXPECT_EQ(zfp_stream_bytes({1 << 30, 1 << 20, 1 << 10}, 64), std::uint64_t{1} << 57U);
}

TEST(ZfpCodec, BlockBitsAreTheMostThatFitTheBytes) {
  EXPECT_EQ(zfp_block_bits({8, 8, 8}, 64), 64U);
  EXPECT_EQ(zfp_block_bits({8, 8, 8}, 72), 72U);
  EXPECT_EQ(zfp_block_bits({8, 8, 8}, 9 + 7), 16U);
  EXPECT_EQ(zfp_block_bits({8, 8, 8}, 8), std::nullopt);  // 8 bits a block
  EXPECT_EQ(zfp_block_bits({8, 8, 8}, 0), std::nullopt);
  EXPECT_EQ(zfp_block_bits({4, 4, 4}, 1 << 20), kMostZfpBits);
  EXPECT_EQ(zfp_block_bits({1, 1, 1}, ~std::uint64_t{0}), kMostZfpBits);
  for (const Index3 extent : {Index3{13, 7, 21}, Index3{64, 64, 64}, Index3{1, 1, 1000}}) {
    for (std::uint64_t bytes = 2000; bytes < 2040; ++bytes) {
      const auto bits = zfp_block_bits(extent, bytes);
      if (!bits) continue;
      EXPECT_LE(zfp_stream_bytes(extent, *bits), bytes);
      EXPECT_GT(zfp_stream_bytes(extent, *bits + 1), bytes);
    }
  }
}

// Uses the library directly: one field, one stream.
TEST(ZfpCodec, EqualsTheZfpLibraryOnTheWholeVolume) {
  const Index3 extent{19, 14, 10};
  std::vector<float> values = waves(extent);
  constexpr unsigned kBits = 333;
  std::vector<std::uint64_t> words(10000);
  bitstream* bits = stream_open(words.data(), words.size() * 8);
  zfp_stream* zfp = zfp_stream_open(bits);
  zfp_field* field = zfp_field_3d(values.data(), zfp_type_float, 19, 14, 10);
  zfp_stream_set_rate(zfp, kBits / 64.0, zfp_type_float, 3, zfp_false);
  const std::size_t bytes = zfp_compress(zfp, field);
  std::vector<float> expected(values.size());
  zfp_field_set_pointer(field, expected.data());
  zfp_stream_rewind(zfp);
  ASSERT_NE(zfp_decompress(zfp, field), 0U);
  zfp_field_free(field);
  zfp_stream_close(zfp);
  stream_close(bits);

  ZfpCodec codec(kBits);
  const std::span<const std::byte> stream = codec.compress({values.data(), extent, extent});
  ASSERT_EQ(stream.size(), bytes);
  EXPECT_EQ(std::memcmp(stream.data(), words.data(), bytes), 0);
  const std::span<const float> decoded = codec.decompress(extent);  // of what compress left in the buffer
  EXPECT_TRUE(std::equal(decoded.begin(), decoded.end(), expected.begin(), expected.end()));
}

TEST(ZfpCodec, PartsDecodeToTheSameValuesAsTheWhole) {
  const Index3 extent{21, 18, 11};
  const std::vector<float> values = waves(extent);
  ZfpCodec codec(200);
  codec.compress({values.data(), extent, extent});
  const std::span<const float> decoded = codec.decompress(extent);
  const std::vector<float> whole(decoded.begin(), decoded.end());
  EXPECT_NE(whole, values);
  const Index3 lo{8, 4, 4};
  const Index3 part = extent - lo;
  codec.compress({&values[static_cast<std::size_t>(linear_index(lo, extent))], part, extent});
  const std::span<const float> inside = codec.decompress(part);
  for (std::int64_t i = 0; i < volume(part); ++i) {
    EXPECT_EQ(inside[static_cast<std::size_t>(i)],
              whole[static_cast<std::size_t>(linear_index(lo + index_at(i, part), extent))]);
  }
}

TEST(ZfpCodec, FewestAndMostBits) {
  const Index3 extent{5, 4, 4};
  const std::vector<float> values(80, 1.0F);
  for (const unsigned bits : {kLeastZfpBits, kMostZfpBits}) {
    ZfpCodec codec(bits);
    EXPECT_EQ(codec.compress({values.data(), extent, extent}).size(), zfp_stream_bytes(extent, bits));
    EXPECT_EQ(codec.decompress(extent).size(), 80U);
  }
}

}  // namespace
}  // namespace weir::zfp_codec_test
