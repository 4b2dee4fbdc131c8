#include "gpu/image/png_input.h"

#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <fstream>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "gpu/image/colormap.h"
#include "gpu/image/image_output.h"
#include "tests/support/temporary_directory.h"

namespace weir::png_input_test {
namespace {

class PngInput : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(directory_ / name, std::ios::binary) << bytes;
    return directory_ / name;
  }
  /// Returns a PNG of `format` with the samples.
  template <typename Sample>
  std::string png(std::uint32_t format, std::uint32_t width, std::uint32_t height,
                  const std::vector<Sample>& samples) const {
    png_image head{};
    head.version = PNG_IMAGE_VERSION;
    head.format = format;
    head.width = width;
    head.height = height;
    std::string path = directory_ / "a.png";
    EXPECT_NE(png_image_write_to_file(&head, path.c_str(), 0, samples.data(), 0, nullptr), 0) << head.message;
    return path;
  }
  static std::string message(const std::string& path) {
    try {
      read_png(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
    return "no error";
  }

  TemporaryDirectory directory_;
};

TEST_F(PngInput, EveryByteValueReadsBackExactly) {
  Image image(16, 16);
  for (std::size_t i = 0; i < 256; ++i) {
    const auto value = [](std::size_t byte) { return linear_from_srgb(static_cast<float>(byte) / 255.0F); };
    image.pixels[i] = {value(i), value(255 - i), value(i * 7 % 256)};
  }
  const std::vector<std::byte> bytes = encode_png(image, {.exposure = 1, .soft_clip = false});
  const Image read = read_png(write("a.png", std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size())));
  EXPECT_EQ(read.width, 16);
  EXPECT_EQ(read.height, 16);
  EXPECT_EQ(read.pixels, image.pixels);
}

TEST_F(PngInput, GrayAndOpaqueColors) {
  const float half = linear_from_srgb(128 / 255.0F);
  const Image gray = read_png(png<std::uint8_t>(PNG_FORMAT_GRAY, 3, 1, {0, 128, 255}));
  EXPECT_EQ(gray.pixels, (std::vector<Float3>{{0, 0, 0}, {half, half, half}, {1, 1, 1}}));
  const Image rgba = read_png(png<std::uint8_t>(PNG_FORMAT_RGBA, 1, 2, {0, 128, 255, 255, 255, 0, 128, 255}));
  EXPECT_EQ(rgba.height, 2);
  EXPECT_EQ(rgba.pixels, (std::vector<Float3>{{0, half, 1}, {1, 0, half}}));
}

TEST_F(PngInput, Refusals) {
  const std::string transparent =
      png<std::uint8_t>(PNG_FORMAT_RGBA, 2, 2, {1, 2, 3, 255, 1, 2, 3, 255, 1, 2, 3, 255, 1, 2, 3, 254});
  EXPECT_EQ(message(transparent), transparent +
                                      ": pixel 1, 1 is transparent (alpha 254); give a picture without, laid "
                                      "over its background");
  const std::string deep = png<std::uint16_t>(PNG_FORMAT_LINEAR_RGB, 1, 1, {1, 2, 3});
  EXPECT_EQ(message(deep), deep + ": 16 bits a channel; give a PNG of 8");
  const std::string text = write("a.txt", "P6 1 1 255\n");
  EXPECT_EQ(message(text), text + ": not a PNG file; give a picture as .png");
  const std::string empty = write("empty.png", "");
  EXPECT_EQ(message(empty), empty + ": the file is empty; give a .png file");
  const std::string none = directory_ / "none.png";
  EXPECT_EQ(message(none), none + ": cannot open: No such file or directory");
}

// A truncated or changed file gives an error of one line or a picture, never a crash.
TEST_F(PngInput, Broken) {
  const std::vector<std::byte> bytes = encode_png(Image(40, 30), {});
  const std::string whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (std::size_t length = 8; length < whole.size() - 12; ++length) {  // readers need not all of the empty last chunk
    const std::string path = write("cut.png", whole.substr(0, length));
    const std::string reason = message(path);
    EXPECT_TRUE(reason.starts_with(path + ": broken PNG file (")) << length << ' ' << reason;
    EXPECT_EQ(reason.find('\n'), std::string::npos);
  }
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 0x41);
    message(write("changed.png", changed));
  }
}

// A header with a valid checksum claims 30000 x 30000 gray pixels, and there is no data.
TEST_F(PngInput, AHeaderAloneTakesNoMemory) {
  std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x75\x30\0\0\x75\x30\x08\0\0\0\0", 29);
  const auto crc = static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + 12), 17));
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(crc >> shift & 0xFF);
  bytes += std::string("\0\0\0\0IDAT\x35\xaf\x06\x1e", 12);
  const std::string path = write("large.png", bytes);
  EXPECT_EQ(message(path), path + ": broken PNG file (30000 x 30000 pixels in 45 bytes)");
}

}  // namespace
}  // namespace weir::png_input_test
