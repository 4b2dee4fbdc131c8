#include "ingest/streams/stream_inflater.h"

#include "tests/ingest/support/packed.h"
#include "tests/ingest/support/scratch.h"

namespace weir::stream_inflater_test {
namespace {

/// Returns test bytes. By default they are more than the inflater's output buffer, and not a multiple of it.
std::vector<std::byte> content(std::size_t bytes = 3 * StreamInflater::kOutputBytes + 17) {
  std::vector<std::byte> values(bytes);
  for (std::size_t i = 0; i < bytes; ++i) values[i] = static_cast<std::byte>((i * i) >> 7U);
  return values;
}

std::vector<std::byte> unpack(std::span<const std::byte> packed, std::size_t piece) {
  std::vector<std::byte> result;
  StreamInflater inflater("data.gz");
  while (!packed.empty()) {
    const auto part = packed.first(std::min(piece, packed.size()));
    inflater.push(part, [&](std::span<const std::byte> bytes) {
      EXPECT_LE(bytes.size(), StreamInflater::kOutputBytes);
      result.insert(result.end(), bytes.begin(), bytes.end());
    });
    packed = packed.subspan(part.size());
  }
  inflater.finish();
  return result;
}

TEST(StreamInflater, UnpacksBothWrappersInPiecesOfAnySize) {
  for (const Wrapper wrapper : {Wrapper::gzip, Wrapper::zlib}) {
    const auto packed = deflated(content(), wrapper);
    for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, packed.size()}) {
      EXPECT_EQ(unpack(packed, piece), content()) << piece;
    }
  }
}

TEST(StreamInflater, UnpacksMembersInARowAndSkipsPadding) {
  auto packed = deflated(content(100), Wrapper::gzip);
  const auto second = deflated(content(5), Wrapper::gzip);
  packed.insert(packed.end(), 3, std::byte{0});
  packed.insert(packed.end(), second.begin(), second.end());
  packed.insert(packed.end(), 512, std::byte{0});
  auto expected = content(100);
  const auto tail = content(5);
  expected.insert(expected.end(), tail.begin(), tail.end());
  for (const std::size_t piece : {std::size_t{1}, packed.size()}) EXPECT_EQ(unpack(packed, piece), expected);
}

TEST(StreamInflater, RefusesAStreamCutAtAnyByte) {
  for (const Wrapper wrapper : {Wrapper::gzip, Wrapper::zlib}) {
    const auto packed = deflated(content(40), wrapper);
    for (std::size_t size = 0; size < packed.size(); ++size) {
      const std::string message =
          message_of_error(ErrorKind::input, [&] { unpack(std::span(packed).first(size), 64); });
      EXPECT_TRUE(message.starts_with("data.gz: the compressed data end too early, the file is cut, at byte " +
                                      std::to_string(size) + " of them"))
          << message;
    }
  }
}

TEST(StreamInflater, NamesTheOffsetOfDamage) {
  auto packed = deflated(content(40), Wrapper::gzip);
  packed.back() ^= std::byte{1};
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { unpack(packed, 64); }),
            "data.gz: damaged compressed data (incorrect length check), at byte " + std::to_string(packed.size()) +
                " of them, 40 unpacked; copy the file again");
  const std::vector<std::byte> text(20, std::byte{'a'});
  EXPECT_EQ(
      message_of_error(ErrorKind::input, [&] { unpack(text, 64); }),
      "data.gz: damaged compressed data (incorrect header check), at byte 2 of them, 0 unpacked; copy the file again");
}

TEST(StreamInflater, RefusesBytesAfterTheStream) {
  auto packed = deflated(content(40), Wrapper::zlib);
  const std::size_t size = packed.size();
  packed.push_back(std::byte{0});
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { unpack(packed, 64); }),
            "data.gz: bytes that belong to nothing after the compressed data, at byte " + std::to_string(size) +
                " of them, 40 unpacked; copy the file again");
}

TEST(StreamInflater, SinkErrorStopsADecompressionBomb) {
  const auto bomb = deflated(std::vector<std::byte>(std::size_t{64} << 20U), Wrapper::gzip);
  std::size_t seen = 0;
  StreamInflater inflater("bomb.gz");
  EXPECT_EQ(message_of_error(ErrorKind::input,
                             [&] {
                               inflater.push(bomb, [&](std::span<const std::byte> bytes) {
                                 seen += bytes.size();
                                 throw Error(ErrorKind::input, "enough");
                               });
                             }),
            "enough");
  EXPECT_EQ(seen, StreamInflater::kOutputBytes);
}

}  // namespace
}  // namespace weir::stream_inflater_test
