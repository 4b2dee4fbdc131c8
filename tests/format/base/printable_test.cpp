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
}

TEST(OneLine, OfBytes_LeavesAllButControlCharacters) {
  EXPECT_EQ(one_line_of_bytes("a\nb\tc\x1b[1m\x7f"), "a\\nb\\tc\\x1b[1m\\x7f");
  EXPECT_EQ(one_line_of_bytes("\xff\xc3\xa4"), "\xff\xc3\xa4");
}

}  // namespace
}  // namespace weir::printable_test
