#include "ingest/zarr/codecs/crc32c.h"

#include <string_view>

#include "tests/ingest/support/scratch.h"

namespace weir::crc32c_test {
namespace {

std::uint32_t of_text(std::string_view text) { return crc32c(std::as_bytes(std::span(text))); }

TEST(Crc32c, IsThatOfRfc3720) {
  EXPECT_EQ(of_text("123456789"), 0xE3069283U);
  EXPECT_EQ(of_text(""), 0U);
  EXPECT_EQ(of_text(std::string(32, '\0')), 0x8A9136AAU);
  EXPECT_EQ(of_text(std::string(32, '\xFF')), 0x62A8AB43U);
}

TEST(Crc32c, ChecksumBehindBytes_IsTakenOffWhereItIsRight) {
  std::vector<std::byte> bytes(13);
  const std::string_view text("123456789\x83\x92\x06\xE3", 13);
  std::memcpy(bytes.data(), text.data(), bytes.size());
  EXPECT_EQ(check_crc32c(bytes).size(), 9U);
  bytes[3] ^= std::byte{1};
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { check_crc32c(bytes); }).substr(0, 32),
            "its crc32c is e3069283, its byte");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { check_crc32c(std::span(bytes).first(3)); }),
            "holds 3 bytes, fewer than its crc32c takes");
}

}  // namespace
}  // namespace weir::crc32c_test
