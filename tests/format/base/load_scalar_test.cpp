#include "format/base/load_scalar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

namespace weir::load_scalar_test {
namespace {

template <typename T>
void expect_loaded(T value) {
  std::array<std::byte, sizeof(T) + 1> bytes{};  // one before it: no alignment
  std::memcpy(bytes.data() + 1, &value, sizeof(T));
  EXPECT_EQ(load_scalar<T>(bytes.data() + 1, kNativeIsBig), value);
  std::reverse(bytes.begin() + 1, bytes.end());
  EXPECT_EQ(load_scalar<T>(bytes.data() + 1, !kNativeIsBig), value);
}

TEST(LoadScalar, BothByteOrders_GiveTheValueOfEveryType) {
  expect_loaded<std::uint8_t>(0x89);
  expect_loaded<std::int8_t>(-7);
  expect_loaded<std::uint16_t>(0x8912);
  expect_loaded<std::int16_t>(-712);
  expect_loaded<std::uint32_t>(0x89123456U);
  expect_loaded<std::int32_t>(-7123456);
  expect_loaded<std::uint64_t>(0x8912345678ABCDEFU);
  expect_loaded<std::int64_t>(std::numeric_limits<std::int64_t>::min() + 7);
  expect_loaded<float>(0.1F);
  expect_loaded<double>(-0.1);
}

}  // namespace
}  // namespace weir::load_scalar_test
