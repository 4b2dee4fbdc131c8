// Tests ChunkInflater with good, damaged and wrongly sized deflate streams.
#include "ingest/chunks/chunk_inflater.h"

#include <vector>

#include "tests/ingest/support/scratch.h"

namespace weir::filter_inflate_test {
namespace {

std::vector<std::byte> deflated(const std::vector<std::byte>& bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<std::byte> stream(size);
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(stream.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                     bytes.size()),
            Z_OK);
  stream.resize(size);
  return stream;
}

std::vector<std::byte> counted(std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * i / 3);
  return bytes;
}

TEST(ChunkInflater, InflatesAgainAfterADamagedStream) {
  ChunkInflater inflater;
  for (const std::size_t size : {1U, 100U, 4096U, 1000000U}) {
    const std::vector<std::byte> expected = counted(size);
    const std::vector<std::byte> stream = deflated(expected);
    std::vector<std::byte> bytes(size);
    EXPECT_THROW(inflater.inflate(std::span(stream).first(stream.size() - 5), bytes), Error);
    inflater.inflate(stream, bytes);
    EXPECT_EQ(bytes, expected);
  }
}

TEST(ChunkInflater, BytesAfterTheStreamAreIgnored) {
  const std::vector<std::byte> expected = counted(1000);
  std::vector<std::byte> stream = deflated(expected);
  stream.resize(stream.size() + 100, std::byte{0xEE});
  std::vector<std::byte> bytes(1000);
  ChunkInflater().inflate(stream, bytes);
  EXPECT_EQ(bytes, expected);
}

std::string message_for(std::span<const std::byte> stream, std::size_t size) {
  std::vector<std::byte> bytes(size + 16, std::byte{0xEE});
  auto message =
      message_of_error(ErrorKind::input, [&] { ChunkInflater().inflate(stream, std::span(bytes).first(size)); });
  for (std::size_t i = size; i < bytes.size(); ++i) EXPECT_EQ(bytes[i], std::byte{0xEE}) << "written beyond the end";
  return message;
}

TEST(ChunkInflater, RefusesStreamsOfTheWrongLength) {
  // A bomb: 64 KiB inflate to 64 MiB of zeros, but the chunk should have 4096 bytes.
  const std::vector<std::byte> bomb = deflated(std::vector<std::byte>(std::size_t{64} << 20U));
  EXPECT_LT(bomb.size(), 70'000U);
  EXPECT_EQ(message_for(bomb, 4096), "its deflate stream holds more than 4096 bytes");
  const std::vector<std::byte> stream = deflated(counted(1000));
  EXPECT_EQ(message_for(stream, 999), "its deflate stream holds more than 999 bytes");
  EXPECT_EQ(message_for(stream, 1001), "its deflate stream ends after 1000 of 1001 bytes");
  EXPECT_EQ(message_for({}, 10), "its deflate stream ends after 0 of 10 bytes");
}

TEST(ChunkInflater, RefusesDamagedStreams) {
  const std::vector<std::byte> expected = counted(1000);
  std::vector<std::byte> stream = deflated(expected);
  stream.back() ^= std::byte{1};
  EXPECT_EQ(message_for(stream, 1000), "its deflate stream is damaged after 1000 of 1000 bytes (incorrect data check)");
  stream.front() = std::byte{0x79};
  EXPECT_EQ(message_for(stream, 1000), "its deflate stream is damaged after 0 of 1000 bytes (incorrect header check)");
  // A stream that is cut at any byte is refused, and nothing is written beyond the end.
  stream = deflated(expected);
  for (std::size_t size = 0; size < stream.size(); ++size) {
    EXPECT_NE(message_for(std::span(stream).first(size), 1000), "") << size;
  }
}

}  // namespace
}  // namespace weir::filter_inflate_test
