#include "gpu/image/radiance_hdr.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "format/base/error.h"

namespace weir::radiance_hdr_test {
namespace {

const std::string kHead = "#?RADIANCE\n# by hand\nFORMAT=32-bit_rle_rgbe\n\n";

Image decode(const std::string& bytes) {
  return decode_radiance_hdr(std::as_bytes(std::span(bytes)), "a.hdr", [](std::int32_t, std::int32_t) {});
}

std::string message(const std::string& bytes) {
  try {
    decode(bytes);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

std::string chars(const std::vector<int>& values) { return {values.begin(), values.end()}; }

// A row of 10 pixels: red is a run of 128, green a literal, blue and the exponent mix runs and literals.
const std::string kRow = chars({2, 2, 0, 10})                         //
                         + chars({128 + 10, 128})                     //
                         + chars({10, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9})  //
                         + chars({128 + 4, 7, 2, 1, 2, 128 + 4, 9})   //
                         + chars({128 + 8, 129, 2, 0, 137});

TEST(RadianceHdr, PackedRows) {
  const Image image = decode(kHead + "-Y 2 +X 10\n" + kRow + kRow);
  ASSERT_EQ(image.width, 10);
  ASSERT_EQ(image.height, 2);
  for (std::int32_t y = 0; y < 2; ++y) {
    EXPECT_EQ(image.at(0, y), (Float3{1, 0, 7.0F / 128}));
    EXPECT_EQ(image.at(4, y), (Float3{1, 4.0F / 128, 1.0F / 128}));
    EXPECT_EQ(image.at(7, y), (Float3{1, 7.0F / 128, 9.0F / 128}));
    EXPECT_EQ(image.at(8, y), (Float3{0, 0, 0})) << "exponent 0 is black";
    EXPECT_EQ(image.at(9, y), (Float3{256, 18, 18}));
  }
}

TEST(RadianceHdr, FlatRowsAndOldRuns) {
  const Image image = decode("#?RGBE\n\n-Y 1 +X 5\n" + chars({64, 32, 16, 128, 1, 1, 1, 3, 0, 0, 8, 136}));
  for (std::int32_t x = 0; x < 4; ++x) EXPECT_EQ(image.at(x, 0), (Float3{0.25F, 0.125F, 0.0625F}));
  EXPECT_EQ(image.at(4, 0), (Float3{0, 0, 8}));
  // 2 + 1 * 256 repetitions, given in two digits.
  const Image run = decode(kHead + "-Y 1 +X 259\n" + chars({128, 0, 0, 129, 1, 1, 1, 2, 1, 1, 1, 1}));
  for (std::int32_t x = 0; x < 259; ++x) EXPECT_EQ(run.at(x, 0), (Float3{1, 0, 0}));
  // (1, 1, 1) as a colour at the start of a row, and a flat row after a packed one.
  EXPECT_EQ(decode(kHead + "-Y 1 +X 1\n" + chars({1, 1, 1, 136})).at(0, 0), (Float3{1, 1, 1}));
  std::string flat;
  for (int x = 0; x < 10; ++x) flat += chars({x + 3, 0, 0, 136});
  const Image mixed = decode(kHead + "-Y 2 +X 10\n" + kRow + flat);
  EXPECT_EQ(mixed.at(0, 0), (Float3{1, 0, 7.0F / 128}));
  for (std::int32_t x = 0; x < 10; ++x) EXPECT_EQ(mixed.at(x, 1), (Float3{static_cast<float>(x + 3), 0, 0}));
}

TEST(RadianceHdr, HeaderWithWindowsLineEnds_IsRead) {
  const Image image = decode("#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n" + chars({128, 64, '\r', 129}));
  ASSERT_EQ(image.width, 1);
  EXPECT_EQ(image.at(0, 0), (Float3{1, 0.5F, 13.0F / 128}));
}

// The file's values were multiplied by EXPOSURE, and this is not undone.
TEST(RadianceHdr, Exposure_ChangesNoValue) {
  const Image image =
      decode("#?RADIANCE\nEXPOSURE=0.5\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" + chars({128, 64, 0, 129}));
  EXPECT_EQ(image.at(0, 0), (Float3{1, 0.5F, 0}));
}

TEST(RadianceHdr, Extremes) {
  const Image image = decode(kHead + "-Y 1 +X 2\n" + chars({255, 255, 255, 255, 128, 0, 0, 1}));
  EXPECT_EQ(image.at(0, 0).x, 255 * 0x1p119F);
  EXPECT_EQ(image.at(1, 0).x, 0x1p-128F);
}

TEST(RadianceHdr, IsRecognisedByItsSignature) {
  const auto is_hdr = [](const std::string& text) { return is_radiance_hdr(std::as_bytes(std::span(text))); };
  EXPECT_TRUE(is_hdr("#?RADIANCE\n"));
  EXPECT_TRUE(is_hdr("#?RGBE\n"));
  EXPECT_FALSE(is_hdr("#?"));
  EXPECT_FALSE(is_hdr(""));
}

TEST(RadianceHdr, Errors) {
  EXPECT_EQ(message("#?RADIANCE"), "a.hdr: offset 0: the header does not end; give a Radiance .hdr file");
  EXPECT_EQ(message("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n"),
            "a.hdr: offset 34: the format is \"32-bit_rle_xyze\", only 32-bit_rle_rgbe is read");
  EXPECT_EQ(message("#?RADIANCE\n\n+Y 2 +X 4\n"),
            "a.hdr: offset 22: the size is \"+Y 2 +X 4\", only -Y HEIGHT +X WIDTH (rows from the top) is read");
  EXPECT_EQ(message("#?RADIANCE\n\n-Y 0 +X 4\n"),
            "a.hdr: offset 22: the size is \"-Y 0 +X 4\", it must be two whole numbers above 0");
  EXPECT_EQ(message("#?RADIANCE\n\n-Y 2 +X 99999999999\n"),
            "a.hdr: offset 32: the size is \"-Y 2 +X 99999999999\", it must be two whole numbers above 0");
  EXPECT_EQ(message("#?RADIANCE\n\n-Y 1 +X 10\n" + chars({2, 2, 0, 9})),
            "a.hdr: offset 27: a row of 9 pixels in a picture 10 wide; the file is broken");
  EXPECT_EQ(message("#?RADIANCE\n\n-Y 1 +X 10\n" + chars({2, 2, 0, 10, 128 + 11})),
            "a.hdr: offset 28: a run of 11 where 10 pixels are left in the row; the file is broken");
  EXPECT_EQ(message("#?RADIANCE\n\n-Y 1 +X 10\n" + chars({2, 2, 0, 10, 0})),
            "a.hdr: offset 28: a run of 0 where 10 pixels are left in the row; the file is broken");
  EXPECT_EQ(message("#?RADIANCE\n\n-Y 1 +X 3\n" + chars({9, 9, 9, 9, 1, 1, 1, 3})),
            "a.hdr: offset 30: a run longer than the row; the file is broken");
}

// A file cut anywhere gives an error, and reading ends.
TEST(RadianceHdr, CutShort) {
  for (const std::string& rows : {kRow + kRow, std::string(80, '\7')}) {
    const std::string whole = kHead + "-Y 2 +X 10\n" + rows;
    ASSERT_EQ(message(whole), "no error");
    for (std::size_t length = 0; length < whole.size(); ++length) {
      EXPECT_NE(message(whole.substr(0, length)), "no error") << length;
    }
    EXPECT_EQ(message(whole.substr(0, whole.size() - 1)),
              "a.hdr: offset " + std::to_string(whole.size() - 1) +
                  ": the file ends here, in the middle of the picture; it was cut short");
  }
}

TEST(RadianceHdr, SizeIsRefusedBeforeMemoryIsTaken) {
  const std::string bytes = kHead + "-Y 2000000000 +X 2000000000\n";
  EXPECT_THROW(decode_radiance_hdr(std::as_bytes(std::span(bytes)), "a.hdr",
                                   [](std::int32_t width, std::int32_t height) {
                                     EXPECT_EQ(width, 2000000000);
                                     EXPECT_EQ(height, 2000000000);
                                     throw Error(ErrorKind::input, "too large");
                                   }),
               Error);
}

}  // namespace
}  // namespace weir::radiance_hdr_test
