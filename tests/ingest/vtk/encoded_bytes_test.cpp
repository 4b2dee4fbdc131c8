#include "ingest/vtk/encoded_bytes.h"

#include "tests/ingest/support/scratch.h"

namespace weir::encoded_bytes_test {
namespace {

std::string decoded(const std::string& text, std::size_t count, bool is_base64 = true) {
  const Scratch scratch;
  InputFile file(scratch.write_values("a", std::vector<char>(text.begin(), text.end())), DirectIo::off);
  EncodedBytes encoded(file, 0, text.size(), is_base64, "a");
  std::string bytes(count, '\0');
  encoded.read(std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

std::string refusal(const std::string& text, std::size_t count, bool is_base64 = true) {
  return message_of_error(ErrorKind::input, [&] { decoded(text, count, is_base64); });
}

// RFC 4648, section 10.
TEST(EncodedBytes, DecodesThePublishedVectors) {
  EXPECT_EQ(decoded("Zg==", 1), "f");
  EXPECT_EQ(decoded("Zm8=", 2), "fo");
  EXPECT_EQ(decoded("Zm9v", 3), "foo");
  EXPECT_EQ(decoded("Zm9vYg==", 4), "foob");
  EXPECT_EQ(decoded("Zm9vYmE=", 5), "fooba");
  EXPECT_EQ(decoded("Zm9vYmFy", 6), "foobar");
  EXPECT_EQ(decoded("+/+/", 3), "\xFB\xFF\xBF");
}

TEST(EncodedBytes, ConcatenatedPaddedTextsDecodeAsOne) { EXPECT_EQ(decoded(" Zg==\n\tZm8=Z m9v ", 6), "ffofoo"); }

TEST(EncodedBytes, RawBytesPassUnchanged) { EXPECT_EQ(decoded("=<\n", 3, false), "=<\n"); }

TEST(EncodedBytes, RefusesInvalidText) {
  EXPECT_EQ(refusal("Zm9", 3), "a: its base64 text ends too early; the file is cut or damaged");
  EXPECT_EQ(refusal("Zm9v", 4), "a: its base64 text ends too early; the file is cut or damaged");
  EXPECT_EQ(refusal("Zm9v</DataArray>", 6),
            "a: its base64 text has the character '<'; it ends too early or is damaged");
  EXPECT_EQ(refusal("Z===", 1), "a: its base64 text has the character '='; it ends too early or is damaged");
  EXPECT_EQ(refusal("Zg=v", 1), "a: its base64 text has the character 'v'; it ends too early or is damaged");
  EXPECT_EQ(refusal("ab", 3, false), "a: its data end too early; the file is cut or damaged");
}

}  // namespace
}  // namespace weir::encoded_bytes_test
