// Tests unshuffle() against the definition of the shuffle filter.
#include "ingest/chunks/unshuffle.h"

#include <gtest/gtest.h>

#include <vector>

namespace weir::filter_unshuffle_test {
namespace {

/// Returns bytes that differ between neighbouring places, so that a test notices a misplaced byte.
std::vector<std::byte> counted(std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 7 + i / 256);
  return bytes;
}

/// Shuffles by the definition: byte j of value i becomes byte i of plane j. Bytes after the last whole value stay.
std::vector<std::byte> shuffled(const std::vector<std::byte>& values, std::size_t value_bytes) {
  const std::size_t count = values.size() / value_bytes;
  std::vector<std::byte> planes = values;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < value_bytes; ++j) planes[j * count + i] = values[i * value_bytes + j];
  }
  return planes;
}

TEST(Unshuffle, TwoValuesByHand) {
  const std::vector<std::byte> planes{std::byte{1}, std::byte{5}, std::byte{2}, std::byte{6}, std::byte{3},
                                      std::byte{7}, std::byte{4}, std::byte{8}, std::byte{9}};
  std::vector<std::byte> values(9);
  unshuffle(planes, 4, values);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(std::to_integer<int>(values[i]), static_cast<int>(i) + 1);
}

TEST(Unshuffle, EveryWidthLengthAndRemainder) {
  for (const std::size_t value_bytes : {1U, 2U, 3U, 4U, 5U, 8U, 12U, 16U, 100U}) {
    for (const std::size_t size : {0U, 1U, 7U, 8U, 63U, 64U, 65U, 257U, 1000U, 4099U}) {
      const std::vector<std::byte> expected = counted(size);
      std::vector<std::byte> values(size, std::byte{0xEE});
      unshuffle(shuffled(expected, value_bytes), value_bytes, values);
      EXPECT_EQ(values, expected) << value_bytes << " bytes a value, " << size << " in all";
    }
  }
}

}  // namespace
}  // namespace weir::filter_unshuffle_test
