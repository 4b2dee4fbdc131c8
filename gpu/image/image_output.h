// Writes pictures to disk: PNG (8-bit sRGB) and OpenEXR (32-bit linear). A picture is complete or absent: it is
// written beside its final path and then renamed.
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

/// Maps radiance to what a screen can show.
struct ToneMapping {
  float exposure = 1;     ///< factor on the radiance
  bool soft_clip = true;  ///< bends radiance above kShoulder towards 1 instead of cutting it
};

/// Radiance up to which a soft clip changes nothing.
inline constexpr float kShoulder = 0.8F;

/// Returns the display-linear value in [0, 1] of one channel.
float tone_map(float radiance, const ToneMapping& tone);

/// Returns 8-bit sRGB, three bytes per pixel, rows from the top.
std::vector<std::uint8_t> encode_rgb24(const Image& image, const ToneMapping& tone);
std::vector<std::byte> encode_png(const Image& image, const ToneMapping& tone);
/// Encodes channels B, G, R in float32 with unchanged radiance.
std::vector<std::byte> encode_exr(const Image& image);

/// An image file to be written. Opening it before the rendering shows whether it can be written.
class ImageFile {
 public:
  /// Throws Error(usage) if `path`, the value of the option `output`, does not end in .png or .exr or is a directory,
  /// and the errors of PartialFile. `files` must outlive the object.
  ImageFile(FileSystem& files, const std::string& path, bool overwrite);

  /// Returns whether the file holds radiance, as OpenEXR does, and not what a screen shows.
  bool linear() const { return exr_; }
  /// Encodes the picture by the path's extension, writes it and renames it to `path`. Returns the bytes written.
  /// Throws the errors of PartialFile::commit.
  std::uint64_t commit(const Image& image, const ToneMapping& tone);

 private:
  bool exr_;
  PartialFile file_;
};

}  // namespace weir
