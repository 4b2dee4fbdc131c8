#include "daemon/log/plain_text.h"

#include <gtest/gtest.h>

namespace weir::plain_text_test {
namespace {

TEST(PlainText, CharactersThatSteerATerminal_AreNotPlain) {
  for (const char* character : {"\n", "\x1b", "\x7f", "\xc2\x80", "\xc2\x9f", "\xe2\x80\xa8", "\xe2\x80\xa9",
                                "\xe2\x80\xaa", "\xe2\x80\xae", "\xe2\x81\xa6", "\xe2\x81\xa9"}) {
    EXPECT_EQ(plain_bytes(character), 0U) << character;
  }
  EXPECT_EQ(plain_bytes(std::string_view("\0", 1)), 0U);
  EXPECT_EQ(plain_bytes("\xe9.raw"), 0U) << "no UTF-8";
  EXPECT_EQ(plain_bytes(""), 0U);
}

TEST(PlainText, OtherCharacters_ArePlain) {
  EXPECT_EQ(plain_bytes(" a"), 1U);
  EXPECT_EQ(plain_bytes("\xc2\xa0"), 2U) << "U+00A0";
  EXPECT_EQ(plain_bytes("\xc3\xa9"), 2U);
  EXPECT_EQ(plain_bytes("\xe2\x80\xa7"), 3U) << "U+2027";
  EXPECT_EQ(plain_bytes("\xe2\x80\xaf"), 3U) << "U+202F";
  EXPECT_EQ(plain_bytes("\xe2\x81\xa5"), 3U) << "U+2065";
  EXPECT_EQ(plain_bytes("\xe2\x81\xaa"), 3U) << "U+206A";
  EXPECT_EQ(plain_bytes("\xf0\x9f\x8c\x8a"), 4U);
}

TEST(PlainText, MaskedText_HasAQuestionMarkForEachByte) {
  EXPECT_EQ(masked_text("caf\xc3\xa9 \xe9\n\xe2\x80\xaewar.a"), "caf\xc3\xa9 ?\?\?\?\?war.a");
  EXPECT_EQ(masked_text(""), "");
}

}  // namespace
}  // namespace weir::plain_text_test
