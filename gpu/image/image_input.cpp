#include "gpu/image/image_input.h"

#include <tinyexr.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_mapping.h"
#include "gpu/image/radiance_hdr.h"

namespace weir {

namespace {

// tinyexr's structures, which are freed on every way out.
struct ExrFile {
  EXRVersion version{};
  EXRHeader header{};
  EXRImage image{};

  ExrFile() {
    InitEXRHeader(&header);
    InitEXRImage(&image);
  }
  ~ExrFile() {
    FreeEXRImage(&image);
    FreeEXRHeader(&header);
  }
  ExrFile(const ExrFile&) = delete;
  ExrFile& operator=(const ExrFile&) = delete;
};

// Throws with the library's reason if `status` is not success.
void check_exr(int status, const char* reason, const std::string& path) {
  const std::string text = reason != nullptr ? reason : cat("code ", status);
  if (reason != nullptr) FreeEXRErrorMessage(reason);
  if (status != TINYEXR_SUCCESS)
    throw input_error(path, cat("broken OpenEXR file (", text.substr(0, text.find('\n')), ")"));
}

// Returns where R, G and B are among the channels; for gray, three times the same channel.
std::array<int, 3> find_channels(const EXRHeader& header, const std::string& path) {
  if (header.num_channels == 1) return {0, 0, 0};
  constexpr std::array<std::string_view, 3> kNames{"R", "G", "B"};
  std::array<int, 3> found{-1, -1, -1};
  for (int c = 0; c < header.num_channels; ++c) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (header.channels[c].name == kNames[k]) found[k] = c;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (found[k] < 0)
      throw input_error(path,
                        cat("there is no channel ", kNames[k], "; give a picture with R, G and B, or one channel"));
  }
  return found;
}

// Copies a block of planes, `width` x `height` with rows of `pitch`, to (x0, y0), without what lies outside the
// image.
void place(unsigned char* const* planes, const std::array<int, 3>& channels, std::int64_t pitch, std::int64_t width,
           std::int64_t height, std::int64_t x0, std::int64_t y0, Image& image) {
  if (planes == nullptr || x0 < 0 || y0 < 0) return;
  const auto value = [&](std::size_t k, std::int64_t at) {
    float v = 0;
    std::memcpy(&v, planes[channels[k]] + 4 * at, sizeof v);
    return v;
  };
  for (std::int64_t y = 0; y < std::min(height, image.height - y0); ++y) {
    for (std::int64_t x = 0; x < std::min(width, image.width - x0); ++x) {
      const std::int64_t at = y * pitch + x;
      image.pixels[static_cast<std::size_t>((y0 + y) * image.width + x0 + x)] = {value(0, at), value(1, at),
                                                                                 value(2, at)};
    }
  }
}

Image decode_exr(std::span<const std::byte> bytes, const std::string& path, const ImageSizeCheck& check) {
  const auto* memory = reinterpret_cast<const unsigned char*>(bytes.data());
  const char* reason = nullptr;
  ExrFile file;
  check_exr(ParseEXRVersionFromMemory(&file.version, memory, bytes.size()), nullptr, path);
  if (file.version.multipart != 0 || file.version.non_image != 0) {
    throw input_error(path, "an OpenEXR file of several parts or of deep pixels; give one with a single flat picture");
  }
  const int parsed = ParseEXRHeaderFromMemory(&file.header, &file.version, memory, bytes.size(), &reason);
  check_exr(parsed, reason, path);
  const EXRBox2i& window = file.header.data_window;
  const std::int64_t width = std::int64_t{window.max_x} - window.min_x + 1;
  const std::int64_t height = std::int64_t{window.max_y} - window.min_y + 1;
  if (width < 1 || height < 1 || width > INT32_MAX || height > INT32_MAX) {
    throw input_error(path, cat("broken OpenEXR file (", width, " x ", height, " pixels)"));
  }
  const std::array<int, 3> channels = find_channels(file.header, path);
  for (int c = 0; c < file.header.num_channels; ++c) {
    if (file.header.pixel_types[c] == TINYEXR_PIXELTYPE_UINT) {
      throw input_error(path,
                        cat("channel ", file.header.channels[c].name, " holds whole numbers; give half or float"));
    }
    file.header.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
  }
  check(static_cast<std::int32_t>(width), static_cast<std::int32_t>(height));
  reason = nullptr;
  const int loaded = LoadEXRImageFromMemory(&file.image, &file.header, memory, bytes.size(), &reason);
  if (loaded != TINYEXR_SUCCESS) InitEXRImage(&file.image);  // already freed by the failed call
  check_exr(loaded, reason, path);

  Image image(static_cast<std::int32_t>(width), static_cast<std::int32_t>(height));
  if (file.header.tiled == 0) {
    place(file.image.images, channels, width, width, height, 0, 0, image);
    return image;
  }
  const std::int64_t tile_width = file.header.tile_size_x;
  const std::int64_t tile_height = file.header.tile_size_y;
  for (int i = 0; i < file.image.num_tiles; ++i) {
    const EXRTile& tile = file.image.tiles[i];
    place(tile.images, channels, tile_width, tile_width, tile_height, tile.offset_x * tile_width,
          tile.offset_y * tile_height, image);
  }
  return image;
}

}  // namespace

Image read_image(const std::string& path, const ImageSizeCheck& check) {
  const FileMapping file(path, ".exr or .hdr");
  const std::span<const std::byte> bytes = file.bytes();
  if (is_radiance_hdr(bytes)) return decode_radiance_hdr(bytes, path, check);
  constexpr std::array<unsigned char, 4> kExr{0x76, 0x2f, 0x31, 0x01};
  if (bytes.size() >= kExr.size() && std::memcmp(bytes.data(), kExr.data(), kExr.size()) == 0) {
    return decode_exr(bytes, path, check);
  }
  throw input_error(path, "neither OpenEXR nor Radiance; give an .exr or .hdr file");
}

}  // namespace weir
