// Pictures on disk: PNG (8-bit sRGB) and OpenEXR (32-bit linear). A picture is
// complete or absent: it is written beside its place and renamed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "format/io/file_system.h"
#include "format/output/partial_file.h"
#include "gpu/image/image.h"

namespace weir {

/// What maps radiance to what a screen can show.
struct ToneMapping {
  float exposure = 1;     ///< factor on the radiance
  bool soft_clip = true;  ///< bends radiance above kShoulder towards 1 instead of cutting it
};

/// Radiance up to which a soft clip changes nothing.
inline constexpr float kShoulder = 0.8F;

/// Display-linear value in [0, 1] of one channel.
float tone_map(float radiance, const ToneMapping& tone);

/// 8-bit sRGB, three bytes a pixel, rows from the top.
std::vector<std::uint8_t> encode_rgb24(const Image& image, const ToneMapping& tone);
std::vector<std::byte> encode_png(const Image& image, const ToneMapping& tone);
/// Channels B, G, R in float32, radiance as it is.
std::vector<std::byte> encode_exr(const Image& image);

/// An image file to be. Opening it finds out before the rendering whether it can be written.
class ImageFile {
 public:
  /// Throws Error(usage) where `path`, which the option `output` gives, does not end in .png or .exr, or is a
  /// directory, and as PartialFile. `files` must outlive the object.
  ImageFile(FileSystem& files, const std::string& path, bool overwrite);

  /// Whether it will hold radiance, as OpenEXR does, and not what a screen shows.
  bool linear() const { return exr_; }
  /// Encodes by the extension, writes, renames to `path`; returns the bytes written. Throws as PartialFile::commit.
  std::uint64_t commit(const Image& image, const ToneMapping& tone);

 private:
  bool exr_;
  PartialFile file_;
};

}  // namespace weir
