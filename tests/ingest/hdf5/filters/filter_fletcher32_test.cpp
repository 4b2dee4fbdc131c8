// Tests the fletcher32 checksum.
#include "ingest/hdf5/filters/undo_filters.h"

#include <cstdint>
#include <vector>

#include "tests/ingest/support/scratch.h"

namespace weir::filter_fletcher32_test {
namespace {

std::vector<std::byte> bytes_of(std::initializer_list<int> values) {
  std::vector<std::byte> bytes;
  for (const int v : values) bytes.push_back(static_cast<std::byte>(v));
  return bytes;
}

TEST(Fletcher32, MatchesSumsComputedByHand) {
  EXPECT_EQ(fletcher32({}), 0U);
  EXPECT_EQ(fletcher32(bytes_of({0, 0, 0, 0})), 0U);
  // The words are 0x0102 and 0x0304, the sums 0x0406 and 0x0102 + 0x0406.
  EXPECT_EQ(fletcher32(bytes_of({1, 2, 3, 4})), 0x05080406U);
  // An odd last byte is the upper half of a word.
  EXPECT_EQ(fletcher32(bytes_of({1, 2, 3})), 0x05040402U);
  // Sums are in ones' complement: 65535 stays and does not become 0.
  EXPECT_EQ(fletcher32(bytes_of({0xFF, 0xFF})), 0xFFFFFFFFU);
  EXPECT_EQ(fletcher32(bytes_of({0xFF, 0xFF, 0, 1})), 0x00010001U);
}

TEST(Fletcher32, LongInputsDoNotOverflow) {
  // Ones' complement has two zeros: n words of 65535 have the sum 65535, no words have the sum 0.
  EXPECT_EQ(fletcher32(std::vector<std::byte>(std::size_t{1} << 20U, std::byte{0xFF})), 0xFFFFFFFFU);
  // The sums of n words of 1 are n and n (n + 1) / 2, modulo 65535.
  constexpr std::uint64_t kWords = 1'000'003;
  std::vector<std::byte> ones(2 * kWords);
  for (std::size_t i = 1; i < ones.size(); i += 2) ones[i] = std::byte{1};
  EXPECT_EQ(fletcher32(ones), (kWords * (kWords + 1) / 2 % 65535) << 16U | kWords % 65535);
}

TEST(Fletcher32, VerifiesTheTrailingChecksum) {
  std::vector<std::byte> bytes = bytes_of({1, 2, 3, 4, 0x06, 0x04, 0x08, 0x05});
  EXPECT_EQ(check_fletcher32(bytes).size(), 4U);
  EXPECT_EQ(check_fletcher32(bytes).data(), bytes.data());
  std::vector<std::byte> before_1_6_3 = bytes_of({1, 2, 3, 4, 0x04, 0x06, 0x05, 0x08});
  EXPECT_EQ(check_fletcher32(before_1_6_3).size(), 4U);
  bytes[0] = std::byte{2};
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { check_fletcher32(bytes); }),
            "its checksum is 84411398, its bytes give 117966086");
  std::vector<std::byte> three(3);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { check_fletcher32(three); }),
            "holds 3 bytes, fewer than its checksum takes");
}

}  // namespace
}  // namespace weir::filter_fletcher32_test
