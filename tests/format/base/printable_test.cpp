#include "format/base/printable.h"

#include <gtest/gtest.h>

namespace weir::printable_test {
namespace {

TEST(Printable, TextOfAnyLanguageIsShownAsItIs) {
  for (const std::string text :
       {"density", "\u03c1 (kg/m\u00b3)", "\u6e29\u5ea6", "\U0001f300", "\u00a0\ud7ff\ue000\U0010ffff", ""}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_EQ(one_line(text), text);
  }
}

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

TEST(Printable, ControlCharactersAreReplacedOrEscaped) {
  EXPECT_EQ(printable("a\n\x1b[31m\x7f"), "a??[31m?");
  EXPECT_EQ(one_line("a\n\t\x1b[31m\x7f"), "a\\n\\t\\x1b[31m\\x7f");
  // U+009B begins a control sequence as ESC [ does.
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "??31m");
  EXPECT_EQ(one_line("\xc2\x9b"
                     "31m"),
            "\\xc2\\x9b31m");
}

TEST(Printable, BytesThatAreNoUtf8AreReplacedOrEscaped) {
  EXPECT_EQ(printable("caf\xe9"), "caf?");
  EXPECT_EQ(one_line("caf\xe9 a\xff"), "caf\\xe9 a\\xff");
  EXPECT_EQ(one_line("\xe2\x82"), "\\xe2\\x82");                    // cut off
  EXPECT_EQ(one_line("\xc0\x8a"), "\\xc0\\x8a");                    // a line end in two bytes
  EXPECT_EQ(one_line("\xe0\x80\x8a"), "\\xe0\\x80\\x8a");           // and in three
  EXPECT_EQ(one_line("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(one_line("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // above U+10FFFF
  EXPECT_EQ(one_line("\xe2"
                     "b"),
            "\\xe2"
            "b");
  EXPECT_EQ(printable("caf\xc3\xa9 \xe9\n\xe2\x80\xaewar.a"), "caf\xc3\xa9 ?\?\?\?\?war.a")
      << "and what turns the direction";
}

TEST(OneLine, OfBytes_LeavesAllButControlCharacters) {
  EXPECT_EQ(one_line_of_bytes("a\nb\tc\x1b[1m\x7f"), "a\\nb\\tc\\x1b[1m\\x7f");
  EXPECT_EQ(one_line_of_bytes("\xff\xc3\xa4"), "\xff\xc3\xa4");
}

}  // namespace
}  // namespace weir::printable_test
