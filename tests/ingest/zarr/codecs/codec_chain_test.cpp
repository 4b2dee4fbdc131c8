#include "ingest/zarr/codecs/codec_chain.h"

#include <zlib.h>

#include <algorithm>

#include "ingest/zarr/codecs/library_codecs.h"
#include "tests/ingest/support/scratch.h"

namespace weir::codec_chain_test {
namespace {

std::vector<std::byte> decoded(const ZarrCodecs& codecs, const ChunkShape& shape, std::span<const std::byte> stored) {
  const ScratchSize size = scratch_size(codecs, shape.bytes());
  ChunkScratch scratch(size.buffer_bytes, size.two);
  EXPECT_LE(stored.size(), size.buffer_bytes);
  std::copy(stored.begin(), stored.end(), scratch.buffer.bytes().begin());
  const auto bytes = decode_chunk(codecs, shape, stored.size(), scratch);
  return {bytes.begin(), bytes.end()};
}

std::string refusal_of(const ZarrCodecs& codecs, const ChunkShape& shape, std::span<const std::byte> stored) {
  return message_of_error(ErrorKind::input, [&] { decoded(codecs, shape, stored); });
}

std::vector<std::byte> zlib_of(std::size_t zeros) {
  const std::vector<Bytef> bytes(zeros);
  uLongf size = compressBound(zeros);
  std::vector<std::byte> stream(size);
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(stream.data()), &size, bytes.data(), zeros), Z_OK);
  stream.resize(size);
  return stream;
}

TEST(CodecChain, TransposedChunks_GetTheOrderOfTheArray) {
  // A chunk of shape (2, 3, 4) is stored as (4, 2, 3). The value at (i, j, k) is 100 i + 10 j + k.
  std::vector<std::byte> stored;
  std::vector<std::byte> expected;
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 3; ++j) stored.push_back(static_cast<std::byte>(100 * i + 10 * j + k));
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 4; ++k) expected.push_back(static_cast<std::byte>(100 * i + 10 * j + k));
  EXPECT_EQ(decoded({{2, 0, 1}, false, {}}, {{2, 3, 4}, 1}, stored), expected);
}

TEST(CodecChain, Filters_AreUndoneFromTheLastOn) {
  // 1, 3, 2, 258 become the 16-bit differences 1, 2, -1, 256, high byte first. The shuffle then puts all first bytes
  // before all second bytes.
  ZarrCodecs codecs{{}, true, {}};
  codecs.filters = {{ZarrFilter::Kind::delta, 1, ScalarType::int16, true}, {ZarrFilter::Kind::shuffle, 2}};
  std::vector<std::byte> stored;
  for (const int byte : {0, 0, 0xFF, 1, 1, 2, 0xFF, 0}) stored.push_back(static_cast<std::byte>(byte));
  std::vector<std::byte> expected;
  for (const int byte : {0, 1, 0, 3, 0, 2, 1, 2}) expected.push_back(static_cast<std::byte>(byte));
  EXPECT_EQ(decoded(codecs, {{1, 2, 2}, 2}, stored), expected);
  codecs.transpose = {2, 1, 0};
  expected.clear();
  for (const int byte : {0, 1, 0, 2, 0, 3, 1, 2}) expected.push_back(static_cast<std::byte>(byte));
  EXPECT_EQ(decoded(codecs, {{1, 2, 2}, 2}, stored), expected);
}

TEST(CodecChain, StreamsOfMoreOrFewerBytes_AreRefused) {
  const ZarrCodecs zlib{{}, false, {ZarrPacker::zlib}};
  const ChunkShape shape{{4, 4, 4}, 2};
  EXPECT_EQ(decoded(zlib, shape, zlib_of(128)), std::vector<std::byte>(128));
  EXPECT_EQ(refusal_of(zlib, shape, zlib_of(1000000)), "its deflate stream holds more than 128 bytes");
  EXPECT_EQ(refusal_of(zlib, shape, zlib_of(127)), "holds 127 bytes, not 128");
  const std::vector<std::byte> whole = zlib_of(128);
  EXPECT_EQ(refusal_of(zlib, shape, std::span(whole).first(3)), "its deflate stream ends after 0 of 128 bytes");
}

std::vector<std::byte> gzip_of(std::span<const std::byte> bytes) {
  constexpr int kGzipWindow = 15 + 16;
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, kGzipWindow, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::vector<std::byte> packed(deflateBound(&stream, bytes.size()));
  stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

TEST(CodecChain, MembersOfAGzipStream_AreReadOneAfterTheOther) {
  const ZarrCodecs gzip{{}, false, {ZarrPacker::gzip}};
  const ChunkShape shape{{2, 4, 4}, 1};
  std::vector<std::byte> expected(32);
  for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = static_cast<std::byte>(i);
  const std::span bytes(expected);
  std::vector<std::byte> stored;
  const auto add = [&](const std::vector<std::byte>& more) { stored.insert(stored.end(), more.begin(), more.end()); };
  for (const std::size_t cut : {0U, 10U, 30U}) add(gzip_of(bytes.subspan(cut, cut == 0 ? 10 : cut == 10 ? 20 : 2)));
  EXPECT_EQ(decoded(gzip, shape, stored), expected);
  const std::vector<std::byte> members = stored;
  add(gzip_of({}));
  add(std::vector<std::byte>(3));
  EXPECT_EQ(decoded(gzip, shape, stored), expected) << "an empty member, and zeros as of tapes";
  stored = members;
  add(gzip_of(bytes.first(1)));
  EXPECT_EQ(refusal_of(gzip, shape, stored), "its deflate stream holds more than 32 bytes");
  stored = members;
  add({std::byte{1}, std::byte{2}});
  EXPECT_EQ(refusal_of(gzip, shape, stored),
            "its deflate stream is damaged after 32 of 32 bytes (incorrect header check)");
  EXPECT_EQ(refusal_of(gzip, shape, std::span(members).first(members.size() - 9)),
            "its deflate stream ends after 32 of 32 bytes");
}

TEST(CodecChain, BloscBlocksLargerThanTheirMemory_AreRefused) {
  if (!has_library_codecs()) GTEST_SKIP() << "this build was left without libblosc and libzstd (WEIR_ZARR_CODECS)";
  const ZarrCodecs blosc{{}, false, {ZarrPacker::blosc}};
  const ChunkShape shape{{8, 1024, 1024}, 1};
  EXPECT_LT(scratch_size(blosc, shape.bytes()).codec_bytes, std::size_t{13} << 20U);
  // A Blosc header that announces 8 MiB in one block, without compressed values.
  std::vector<std::byte> header(24);
  header[0] = std::byte{2};
  header[1] = header[3] = std::byte{1};
  header[6] = header[10] = std::byte{0x80};
  header[12] = std::byte{24};
  EXPECT_EQ(refusal_of(blosc, shape, header),
            "its blosc blocks have 8388608 bytes, more than the 4194304 that are decoded; write it with blocksize 0");
  header[11] = std::byte{0x80};
  EXPECT_EQ(refusal_of(blosc, shape, header), "its blosc buffer of 8388608 bytes is damaged (its blocks are larger)");
  header[11] = std::byte{0};
  header[7] = std::byte{0x7F};
  EXPECT_EQ(refusal_of(blosc, shape, header), "its blosc buffer holds 2139095040 bytes, more than 8388608");
  EXPECT_EQ(refusal_of(blosc, shape, std::span(header).first(8)), "its 8 bytes are no whole blosc buffer");
}

}  // namespace
}  // namespace weir::codec_chain_test
