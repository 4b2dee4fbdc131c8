// How bricks lie in a texture.
#pragma once

#include <cstdint>

#include "gpu/cuda/bricks/page_table.h"
#include "gpu/cuda/volume/texture.h"

namespace weir {

inline std::uint64_t brick_bytes(TexelType type) {
  return static_cast<std::uint64_t>(kBrickTexels) * texel_bytes(type);
}

/// Bricks along each axis of a texture.
struct TextureShape {
  static constexpr std::uint32_t kMaxAcross = kMaxTextureEdge / kBrickEdge;  ///< along x and y
  static constexpr std::uint32_t kMaxLayers = 1023;                          ///< along z: limited by an entry's bits

  std::uint32_t x = 1;
  std::uint32_t y = 1;
  std::uint32_t z = 1;

  std::uint64_t size() const { return static_cast<std::uint64_t>(x) * y * z; }
  Int3 texels() const {
    const auto edge = [](std::uint32_t n) { return static_cast<std::int32_t>(n) * kBrickEdge; };
    return {edge(x), edge(y), edge(z)};
  }
};

/// Returns a shape as near to a cube as the limits allow, for at least `bricks` bricks, or the largest possible
/// shape.
inline TextureShape shape_for(std::uint64_t bricks) {
  TextureShape shape;
  while (shape.size() < bricks) {
    std::uint32_t* shortest = nullptr;
    const auto consider = [&](std::uint32_t& edge, std::uint32_t limit) {
      if (edge < limit && (shortest == nullptr || edge < *shortest)) shortest = &edge;
    };
    consider(shape.x, TextureShape::kMaxAcross);
    consider(shape.y, TextureShape::kMaxAcross);
    consider(shape.z, TextureShape::kMaxLayers);
    if (shortest == nullptr) break;
    ++*shortest;
  }
  return shape;
}

/// Returns a shape with at most `bytes` bytes of bricks.
inline TextureShape shape_within(std::uint64_t bytes, TexelType type) {
  const std::uint64_t bricks = bytes / brick_bytes(type);
  TextureShape shape = shape_for(bricks);
  while (shape.size() > bricks && shape.z > 1) --shape.z;
  return shape;
}

}  // namespace weir
