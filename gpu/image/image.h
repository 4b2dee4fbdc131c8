// A picture in linear light.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "gpu/math/vector3.h"

namespace weir {

/// Linear RGB radiance, rows from the top, x fastest.
struct Image {
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::vector<Float3> pixels;

  Image() = default;
  Image(std::int32_t w, std::int32_t h)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  std::size_t index(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  const Float3& at(std::int32_t x, std::int32_t y) const { return pixels[index(x, y)]; }
};

/// Called with a picture's size before memory is allocated for its pixels. Throws to refuse the picture.
using ImageSizeCheck = std::function<void(std::int32_t width, std::int32_t height)>;

}  // namespace weir
