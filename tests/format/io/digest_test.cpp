#include "format/io/digest.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "format/io/memory_file_system.h"
#include "tests/support/temporary_directory.h"

namespace weir::digest_test {
namespace {

std::vector<std::byte> pattern(std::size_t bytes) {
  std::vector<std::byte> data(bytes);
  std::uint32_t state = 1;
  for (std::byte& byte : data) {
    state = state * 1664525U + 1013904223U;
    byte = static_cast<std::byte>(state >> 24U);
  }
  return data;
}

// The reference values are of `xxhsum -H2` (xxHash 0.8), which prints the canonical form.
TEST(PlacedChecksum, IsXxh3OfTheBytesWithTheirPlaceAsSeed) {
  EXPECT_EQ(placed_checksum(0, {}), 0x2D06800538D394C2U);  // the XXH3_64bits of nothing
  const std::array<std::byte, 3> bytes{std::byte{1}, std::byte{2}, std::byte{3}};
  EXPECT_EQ(placed_checksum(5, bytes), placed_checksum(5, bytes));
  EXPECT_NE(placed_checksum(5, bytes), placed_checksum(6, bytes));
}

TEST(Digest, IsXxh3InCanonicalForm) {
  EXPECT_EQ(piece_digest({}).hex(), "99aa06d3014798d86001c324468d497f");
  const std::string text = "weir";
  EXPECT_EQ(piece_digest(std::as_bytes(std::span(text))).hex(), "58611f8d7be1fe2c3921234764190df9");
}

TEST(Digest, OfLeafIsOfLittleEndianFloats) {
  const std::vector<float> values{1.0F, -2.5F, 0.0F};
  const std::vector<unsigned char> bytes{0, 0, 0x80, 0x3f, 0, 0, 0x20, 0xc0, 0, 0, 0, 0};
  EXPECT_EQ(leaf_digest(values), piece_digest(std::as_bytes(std::span(bytes))));
}

TEST(Digest, StreamedDigestEqualsTheCombinedDigest) {
  std::vector<Digest> pieces;
  for (std::size_t i = 0; i < 100; ++i) pieces.push_back(piece_digest(pattern(i)));
  DigestStream one_by_one;
  for (const Digest& piece : pieces) one_by_one.update(piece);
  DigestStream in_two;
  in_two.update(std::span(pieces).first(33));
  DigestStream moved = std::move(in_two);
  moved.update(std::span(pieces).subspan(33));
  EXPECT_EQ(one_by_one.digest(), combine(pieces));
  EXPECT_EQ(moved.digest(), combine(pieces));
  EXPECT_EQ(DigestStream().digest(), piece_digest({}));
}

TEST(Digest, FilesHavePiecesOf16MiB) {
  EXPECT_EQ(piece_count(0), 0U);
  EXPECT_EQ(piece_count(1), 1U);
  EXPECT_EQ(piece_count(kDigestPieceBytes), 1U);
  EXPECT_EQ(piece_count(kDigestPieceBytes + 1), 2U);
}

TEST(Digest, OfAWholeFile_CombinesThoseOfItsPieces) {
  const std::vector<std::byte> bytes(kDigestPieceBytes + 5, std::byte{3});
  const std::span<const std::byte> all(bytes);
  const std::array<Digest, 2> pieces{piece_digest(all.first(kDigestPieceBytes)), piece_digest(all.last(5))};
  MemoryFileSystem files;
  const auto file = files.create("a");
  EXPECT_EQ(whole_digest(*file), piece_digest({})) << "an empty one";
  file->write_at(0, all);
  EXPECT_EQ(whole_digest(*file), combine(pieces));
  EXPECT_EQ(whole_digest(all), combine(pieces));
}

}  // namespace
}  // namespace weir::digest_test
