// Pictures of surroundings, given by a formula.
#pragma once

#include "gpu/scene/environment.h"

namespace weir::test {

/// Returns a picture of `height` rows; `radiance(x, y)` gives texel (x, y).
template <class F>
Image surroundings(std::int32_t height, const F& radiance) {
  Image image(2 * height, height);
  for (std::int32_t y = 0; y < height; ++y) {
    for (std::int32_t x = 0; x < 2 * height; ++x) image.pixels[image.index(x, y)] = radiance(x, y);
  }
  return image;
}

inline Environment even(std::int32_t height, float radiance) {
  return {surroundings(height, [&](int, int) { return Float3{radiance, radiance, radiance}; }), {}, "even"};
}

}  // namespace weir::test
