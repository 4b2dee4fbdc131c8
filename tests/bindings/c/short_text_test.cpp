#include "bindings/c/short_text.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "format/base/utf8.h"

namespace weir::c_short_text_test {
namespace {

std::string shortened(const std::string& text, std::size_t bytes) {
  std::vector<char> out(bytes, 'x');
  c::copy_shortened(text, out);
  return out.data();
}

TEST(ShortText, TextThatFits_IsCopied) {
  EXPECT_EQ(shortened("", 8), "");
  EXPECT_EQ(shortened("1234567", 8), "1234567");
}

TEST(ShortText, LongText_LosesItsMiddle) {
  EXPECT_EQ(shortened("12345678", 8), "12...78");
  EXPECT_EQ(shortened("/a/long/path/v.nvdb: cannot write: No space left; free some", 34),
            "/a/long/path/v....left; free some");
}

TEST(ShortText, Characters_AreNotCut) {
  for (const std::string character : {"\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\x8C\x8A"}) {
    std::string text = "a";
    for (int i = 0; i < 50; ++i) text += character;
    for (std::size_t bytes = 8; bytes < 60; ++bytes) {
      const std::string cut = shortened(text, bytes);
      EXPECT_TRUE(is_utf8(cut)) << character << bytes;
      EXPECT_LT(cut.size(), bytes);
      EXPECT_GT(cut.size() + 2 * character.size(), bytes);
      EXPECT_NE(cut.find("..."), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace weir::c_short_text_test
