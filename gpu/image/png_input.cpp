#include "gpu/image/png_input.h"

#include <png.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_mapping.h"
#include "gpu/image/colormap.h"

namespace weir {

namespace {

/// libpng's reader, which is freed on every way out.
struct PngFile {
  png_image head{};

  PngFile() { head.version = PNG_IMAGE_VERSION; }
  ~PngFile() { png_image_free(&head); }
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;
};

}  // namespace

Image read_png(const std::string& path) {
  const FileMapping mapping(path, ".png");
  const std::span<const std::byte> bytes = mapping.bytes();
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  if (bytes.size() < kSignature.size() || std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) != 0) {
    throw input_error(path, "not a PNG file; give a picture as .png");
  }
  PngFile file;
  png_image& head = file.head;
  const auto broken = [&] { throw input_error(path, cat("broken PNG file (", head.message, ")")); };
  if (png_image_begin_read_from_memory(&head, bytes.data(), bytes.size()) == 0) broken();
  if ((head.format & PNG_FORMAT_FLAG_LINEAR) != 0) throw input_error(path, "16 bits a channel; give a PNG of 8");
  // A header may lie, so check it before allocating memory: deflate compresses to no less than 1/1032, and a pixel
  // has at least one bit.
  const std::uint64_t pixels = std::uint64_t{head.width} * head.height;
  if (pixels / 8 / 1032 > bytes.size()) {
    throw input_error(path,
                      cat("broken PNG file (", head.width, " x ", head.height, " pixels in ", bytes.size(), " bytes)"));
  }
  head.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> rgba(pixels * 4);
  if (png_image_finish_read(&head, nullptr, rgba.data(), 0, nullptr) == 0) broken();

  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = linear_from_srgb(static_cast<float>(i) / 255.0F);
  Image image(static_cast<std::int32_t>(head.width), static_cast<std::int32_t>(head.height));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::uint8_t* p = rgba.data() + 4 * i;
    if (p[3] != 255) {
      throw input_error(path, cat("pixel ", i % head.width, ", ", i / head.width, " is transparent (alpha ", int{p[3]},
                                  "); give a picture without, laid over its background"));
    }
    image.pixels[i] = {linear[p[0]], linear[p[1]], linear[p[2]]};
  }
  return image;
}

}  // namespace weir
