// Tests the helpers for text headers: lines, words, numbers, quotes and paths.
#include "ingest/headers/header_text.h"

#include <cmath>
#include <limits>

#include "tests/ingest/support/scratch.h"

namespace weir::header_text_test {
namespace {

TEST(LineReader, EndsLinesAtLfAndCrLf) {
  LineReader lines("a\r\n\nb\rc\n d");
  EXPECT_EQ(lines.next(), "a");
  EXPECT_EQ(lines.position(), 3);
  EXPECT_EQ(lines.next(), "");
  EXPECT_EQ(lines.next(), "b\rc");
  EXPECT_FALSE(lines.open_ended());
  EXPECT_EQ(lines.next(), " d");
  EXPECT_TRUE(lines.open_ended());
  EXPECT_EQ(lines.number(), 4);
  EXPECT_EQ(lines.next(), std::nullopt);
  EXPECT_EQ(LineReader("").next(), std::nullopt);
}

TEST(HeaderText, CutsWords) {
  EXPECT_EQ(trimmed(" \ta b\r\n"), "a b");
  EXPECT_EQ(trimmed(" \t"), "");
  EXPECT_EQ(words("  a\tbc  d "), (std::vector<std::string_view>{"a", "bc", "d"}));
  EXPECT_TRUE(words(" ").empty());
  EXPECT_EQ(lower_case("Data FILE \xC3\x84"), "data file \xC3\x84");
}

TEST(HeaderText, ParsesNumbers) {
  EXPECT_EQ(parse_ints("1 -2\t+3"), (std::vector<std::int64_t>{1, -2, 3}));
  EXPECT_EQ(parse_ints(""), std::vector<std::int64_t>{});
  EXPECT_EQ(parse_ints("1 x"), std::nullopt);
  EXPECT_EQ(parse_ints("9223372036854775808"), std::nullopt);
  EXPECT_EQ(parse_doubles("1 +0.5 1e-3"), (std::vector<double>{1, 0.5, 1e-3}));
  EXPECT_EQ(parse_doubles("inf"), std::vector<double>{std::numeric_limits<double>::infinity()});
  EXPECT_TRUE(std::isnan(parse_doubles("NaN")->front()));
  EXPECT_EQ(parse_doubles("1,5"), std::nullopt);
}

TEST(HeaderText, QuotedTextIsPrintableAndShort) {
  EXPECT_EQ(in_quotes("a b"), "'a b'");
  EXPECT_EQ(in_quotes(std::string_view("a\nb\0c\xFF", 6)), "'a?b?c?'");
  EXPECT_EQ(in_quotes(std::string(61, 'x')), "'" + std::string(60, 'x') + "...'");
}

TEST(HeaderText, FindsFilesBesideTheHeader) {
  EXPECT_EQ(path_beside("/data/a.mhd", "a.raw"), "/data/a.raw");
  EXPECT_EQ(path_beside("/data/a.mhd", "../b/a.raw"), "/data/../b/a.raw");
  EXPECT_EQ(path_beside("/data/a.mhd", "/b/a.raw"), "/b/a.raw");
  EXPECT_EQ(path_beside("a.mhd", "a.raw"), "a.raw");
}

TEST(HeaderText, ReadsNoMoreThanTheLimit) {
  const Scratch scratch;
  InputFile large(scratch.write("large", std::vector<std::byte>(kHeaderLimit + 1, std::byte{'x'})), DirectIo::off);
  EXPECT_EQ(read_head(large), std::string(kHeaderLimit, 'x'));
  InputFile small(scratch.write("small", std::vector<std::byte>(3, std::byte{'y'})), DirectIo::off);
  EXPECT_EQ(read_head(small), "yyy");
}

}  // namespace
}  // namespace weir::header_text_test
