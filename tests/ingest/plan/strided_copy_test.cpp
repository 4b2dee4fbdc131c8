#include "ingest/plan/strided_copy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <vector>

namespace weir::strided_copy_test {
namespace {

constexpr Box kBox{{-3, 5, 100}, {37, 28, 109}};
constexpr Index3 kExtent = kBox.extent();

// An array with its bytes. Function stored() stores its axes in `order` (fastest first), with `gap` bytes between
// values, and if `backwards`, with every axis reversed. Each voxel holds its linear index, cast to the value type.
struct Stored {
  std::vector<std::byte> bytes;
  StridedVoxels voxels;
};

template <typename T>
Stored stored(const std::array<std::size_t, 3>& order, std::int64_t gap, bool backwards) {
  const std::array<std::int64_t, 3> extent{kExtent.x, kExtent.y, kExtent.z};
  Stored made;
  std::int64_t stride = static_cast<std::int64_t>(sizeof(T)) + gap;
  std::int64_t first = 0;
  for (const std::size_t axis : order) {
    made.voxels.stride[axis] = backwards ? -stride : stride;
    if (backwards) first += stride * (extent[axis] - 1);
    stride *= extent[axis];
  }
  made.bytes.resize(static_cast<std::size_t>(stride));
  made.voxels.box = kBox;
  made.voxels.first = made.bytes.data() + first;
  made.voxels.value_bytes = sizeof(T);
  const auto& s = made.voxels.stride;
  for_each_index({{}, kExtent}, [&](const Index3& i) {
    const T value = static_cast<T>(linear_index(i, kExtent));
    std::memcpy(made.bytes.data() + first + i.x * s[0] + i.y * s[1] + i.z * s[2], &value, sizeof value);
  });
  return made;
}

template <typename T>
void expect_copies() {
  std::array<std::size_t, 3> order{0, 1, 2};
  do {
    for (const std::int64_t gap : {0, 3}) {
      for (const bool backwards : {false, true}) {
        const Stored from = stored<T>(order, gap, backwards);
        for (const Box& part : {kBox, Box{{-3, 5, 103}, {37, 28, 104}}, Box{{-3, 9, 100}, {37, 11, 109}},
                                Box{{0, 6, 101}, {35, 25, 106}}, Box{{36, 27, 108}, {37, 28, 109}}}) {
          std::vector<T> copied(static_cast<std::size_t>(part.voxels()) + 1, T{77});
          copy_voxels(from.voxels, part, std::as_writable_bytes(std::span(copied)).data());
          for (std::int64_t i = 0; i < part.voxels(); ++i) {
            const Index3 at = part.lo + index_at(i, part.extent()) - kBox.lo;
            ASSERT_EQ(copied[static_cast<std::size_t>(i)], static_cast<T>(linear_index(at, kExtent)))
                << i << " of " << order[0] << order[1] << order[2] << " gap " << gap << " backwards " << backwards;
          }
          ASSERT_EQ(copied.back(), T{77});
        }
      }
    }
  } while (std::ranges::next_permutation(order).found);
}

TEST(StridedCopy, CopiesAnyPartOfAnyLayout) {
  expect_copies<std::uint8_t>();
  expect_copies<std::uint16_t>();
  expect_copies<std::uint32_t>();
  expect_copies<std::uint64_t>();
}

TEST(StridedCopy, ZeroStrideRepeatsTheValue) {
  const std::uint32_t value = 0xABCDEF01U;
  std::vector<std::uint32_t> copied(24);
  copy_voxels({{{0, 0, 0}, {4, 3, 2}}, reinterpret_cast<const std::byte*>(&value), {0, 0, 0}, 4},
              {{0, 0, 0}, {4, 3, 2}}, std::as_writable_bytes(std::span(copied)).data());
  EXPECT_EQ(copied, std::vector<std::uint32_t>(24, value));
}

}  // namespace
}  // namespace weir::strided_copy_test
