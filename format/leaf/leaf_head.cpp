#include "format/leaf/leaf_head.h"

#include <array>
#include <cstring>

#include "format/base/little_endian.h"
#include "format/layout/nanovdb_layout.h"

namespace weir {
namespace {

// Active mask of a leaf, one byte per (x, y) row of eight z.
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

}  // namespace

void write_leaf_head(const Box& node, const Box& inside, std::uint8_t flags, std::span<std::byte> image) {
  using namespace nvdb::leaf;
  constexpr std::uint8_t kHasBox = 2;
  std::memset(image.data(), 0, nvdb::kLeafHeadBytes);
  const Index3 last = inside.extent() - Index3{1, 1, 1};
  store(image, kBBoxMin, static_cast<std::int32_t>(inside.lo.x));
  store(image, kBBoxMin + 4, static_cast<std::int32_t>(inside.lo.y));
  store(image, kBBoxMin + 8, static_cast<std::int32_t>(inside.lo.z));
  store(image, kBBoxDim, static_cast<std::uint8_t>(last.x));
  store(image, kBBoxDim + 1, static_cast<std::uint8_t>(last.y));
  store(image, kBBoxDim + 2, static_cast<std::uint8_t>(last.z));
  store(image, kFlags, static_cast<std::uint8_t>(kHasBox | flags));
  store(image, kValueMask, active_rows(node, inside));
}

}  // namespace weir
