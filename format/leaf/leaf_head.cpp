#include "format/leaf/leaf_head.h"

#include <array>
#include <cstring>

#include "format/base/little_endian.h"
#include "format/layout/nanovdb_layout.h"

namespace weir {
namespace {

// Returns the active mask of a leaf, one byte per (x, y) row of eight z.
std::array<std::uint8_t, 64> active_rows(const Box& node, const Box& inside) {
  std::array<std::uint8_t, 64> rows{};
  const Index3 lo = inside.lo - node.lo;
  const Index3 hi = inside.hi - node.lo;
  const auto row = static_cast<std::uint8_t>(((1U << static_cast<unsigned>(hi.z)) - 1U) &
                                             ~((1U << static_cast<unsigned>(lo.z)) - 1U));
  for (std::int64_t x = lo.x; x < hi.x; ++x) {
    for (std::int64_t y = lo.y; y < hi.y; ++y) rows[static_cast<std::size_t>(x * 8 + y)] = row;
  }
  return rows;
}

void write_box(const Box& active, std::span<std::byte> image) {
  using namespace nvdb::leaf;
  const Index3 last = active.extent() - Index3{1, 1, 1};
  store(image, kBBoxMin, static_cast<std::int32_t>(active.lo.x));
  store(image, kBBoxMin + 4, static_cast<std::int32_t>(active.lo.y));
  store(image, kBBoxMin + 8, static_cast<std::int32_t>(active.lo.z));
  store(image, kBBoxDim, static_cast<std::uint8_t>(last.x));
  store(image, kBBoxDim + 1, static_cast<std::uint8_t>(last.y));
  store(image, kBBoxDim + 2, static_cast<std::uint8_t>(last.z));
}

}  // namespace

void write_leaf_head(const Box& node, const Box& inside, std::uint8_t flags, std::span<std::byte> image) {
  using namespace nvdb::leaf;
  constexpr std::uint8_t kHasBox = 2;
  std::memset(image.data(), 0, nvdb::kLeafHeadBytes);
  write_box(inside, image);
  store(image, kFlags, static_cast<std::uint8_t>(kHasBox | flags));
  store(image, kValueMask, active_rows(node, inside));
}

Box box_of(const LeafMask& mask, const Box& node) {
  Box box{node.hi, node.lo};
  for (std::size_t n = 0; n < mask.size(); ++n) {
    if (!mask[n]) continue;
    const auto at = static_cast<std::int64_t>(n);
    const Index3 voxel = node.lo + Index3{at >> 6, at >> 3 & 7, at & 7};
    box = {min(box.lo, voxel), max(box.hi, voxel + Index3{1, 1, 1})};
  }
  return box;
}

void set_active_voxels(const Box& node, const LeafMask& mask, std::span<std::byte> image) {
  std::array<std::uint8_t, kLeafVoxels / 8> rows{};
  for (std::size_t n = 0; n < mask.size(); ++n) {
    if (mask[n]) rows[n / 8] = static_cast<std::uint8_t>(rows[n / 8] | 1U << n % 8);
  }
  write_box(box_of(mask, node), image);
  store(image, nvdb::leaf::kValueMask, rows);
}

}  // namespace weir
