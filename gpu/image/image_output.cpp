#include "gpu/image/image_output.h"

#include <png.h>
#include <tinyexr.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/output_names.h"
#include "format/output/output_files.h"
#include "gpu/image/colormap.h"

namespace weir {

namespace {

std::uint8_t to_byte(float display_linear) {
  return static_cast<std::uint8_t>(std::lround(srgb_from_linear(display_linear) * 255.0F));
}

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

// Tells the format from the requested name.
bool is_exr(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension != ".exr" && extension != ".png") {
    throw Error(ErrorKind::usage, compose(option("output", path), ": an image's name must end in .png or .exr"));
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(ErrorKind::usage, cat(path, ": is a directory; name a file in it"));
  }
  return extension == ".exr";
}

}  // namespace

float tone_map(float radiance, const ToneMapping& tone) {
  const float v = radiance * tone.exposure;
  if (!(v > 0.0F)) return 0.0F;
  if (!tone.soft_clip) return std::min(v, 1.0F);
  if (v <= kShoulder) return v;
  const float over = (v - kShoulder) / (1.0F - kShoulder);
  if (!is_finite(over)) return 1.0F;
  return kShoulder + (1.0F - kShoulder) * (over / (1.0F + over));
}

std::vector<std::uint8_t> encode_rgb24(const Image& image, const ToneMapping& tone) {
  std::vector<std::uint8_t> rows(image.pixels.size() * 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Float3& p = image.pixels[i];
    rows[3 * i] = to_byte(tone_map(p.x, tone));
    rows[3 * i + 1] = to_byte(tone_map(p.y, tone));
    rows[3 * i + 2] = to_byte(tone_map(p.z, tone));
  }
  return rows;
}

std::vector<std::byte> encode_png(const Image& image, const ToneMapping& tone) {
  const std::vector<std::uint8_t> rows = encode_rgb24(image, tone);
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  head.width = static_cast<png_uint_32>(image.width);
  head.height = static_cast<png_uint_32>(image.height);
  head.format = PNG_FORMAT_RGB;
  png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(head);  // an upper bound; avoids compressing twice
  std::vector<std::byte> png(bytes);
  if (png_image_write_to_memory(&head, png.data(), &bytes, 0, rows.data(), 0, nullptr) == 0) {
    throw Error(ErrorKind::internal, cat("libpng: ", head.message));
  }
  png.resize(bytes);
  return png;
}

std::vector<std::byte> encode_exr(const Image& image) {
  constexpr std::array kNames{"B", "G", "R"};  // OpenEXR wants channels in alphabetical order
  std::array<std::vector<float>, 3> planes;
  for (auto& plane : planes) plane.resize(image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    planes[0][i] = image.pixels[i].z;
    planes[1][i] = image.pixels[i].y;
    planes[2][i] = image.pixels[i].x;
  }
  std::array<unsigned char*, 3> pointers{};
  std::array<EXRChannelInfo, 3> channels{};
  std::array<int, 3> types{};
  for (std::size_t c = 0; c < 3; ++c) {
    pointers[c] = reinterpret_cast<unsigned char*>(planes[c].data());
    std::strcpy(channels[c].name, kNames[c]);
    types[c] = TINYEXR_PIXELTYPE_FLOAT;
  }
  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = 3;
  header.channels = channels.data();
  header.pixel_types = types.data();
  header.requested_pixel_types = types.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  EXRImage exr;
  InitEXRImage(&exr);
  exr.num_channels = 3;
  exr.images = pointers.data();
  exr.width = image.width;
  exr.height = image.height;

  unsigned char* encoded = nullptr;
  const char* reason = nullptr;
  const std::size_t bytes = SaveEXRImageToMemory(&exr, &header, &encoded, &reason);
  const std::unique_ptr<unsigned char, decltype(&std::free)> owner(encoded, &std::free);
  if (bytes == 0) {
    const std::string message = reason != nullptr ? reason : "unknown fault";
    FreeEXRErrorMessage(reason);
    throw Error(ErrorKind::internal, cat("tinyexr: ", message));
  }
  const auto* first = reinterpret_cast<const std::byte*>(encoded);
  return {first, first + bytes};
}

ImageFile::ImageFile(FileSystem& files, const std::string& path, bool overwrite)
    : exr_(is_exr(path)), file_(files, path, overwrite) {}

std::uint64_t ImageFile::commit(const Image& image, const ToneMapping& tone) {
  const std::vector<std::byte> bytes = exr_ ? encode_exr(image) : encode_png(image, tone);
  file_.file().write_at(0, bytes);
  file_.commit();
  return bytes.size();
}

}  // namespace weir
