#include "ingest/plan/page_buffer.h"

#include <algorithm>
#include <cstdint>
#include <fstream>

#include "tests/ingest/support/scratch.h"

namespace weir::page_buffer_test {
namespace {

TEST(PageBuffer, AlignedAndZero) {
  PageBuffer buffer(10'000);
  ASSERT_EQ(buffer.bytes().size(), 10'000U);
  EXPECT_EQ(buffer.floats().size(), 2'500U);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.bytes().data()) % 4096, 0U);
  EXPECT_TRUE(std::all_of(buffer.floats().begin(), buffer.floats().end(), [](float v) { return v == 0.0F; }));
  buffer.floats().back() = 2.0F;
  PageBuffer moved = std::move(buffer);
  EXPECT_EQ(moved.floats().back(), 2.0F);
  moved = PageBuffer(0);
  EXPECT_TRUE(moved.bytes().empty());
}

TEST(PageBuffer, OfLargePagesAsFarAsTheyFillIt) {
  constexpr std::size_t kLargePage = std::size_t{2} << 20U;
  for (const std::size_t size : {kLargePage - 1, kLargePage, 2 * kLargePage + 5000, 9 * kLargePage + 1}) {
    const PageBuffer buffer(size);
    ASSERT_EQ(buffer.bytes().size(), size);
    if (size >= kLargePage) {
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(buffer.bytes().data()) % kLargePage, 0U) << size;
    }
    EXPECT_EQ(std::count(buffer.bytes().begin(), buffer.bytes().end(), std::byte{0}), std::ptrdiff_t(size));
    std::fill(buffer.bytes().begin(), buffer.bytes().end(), std::byte{7});
  }
}

TEST(PageBuffer, GivesAllOfItsAddressesBack) {
  const auto mapped = [] {
    std::ifstream status("/proc/self/statm");
    std::uint64_t pages = 0;
    status >> pages;
    return pages;
  };
  { const PageBuffer first(std::size_t{5} << 20U); }
  const std::uint64_t before = mapped();
  for (int i = 0; i < 20; ++i) const PageBuffer buffer((std::size_t{5} << 20U) + 12'345);
  EXPECT_EQ(mapped(), before);
}

TEST(PageBuffer, RefusedMemoryIsAnError) {
  EXPECT_EQ(message_of_error(ErrorKind::io, [] { PageBuffer(std::size_t{1} << 62U); }),
            "memory: cannot get 4611686018427387904 bytes for reading; lower --memory: Cannot allocate memory");
}

}  // namespace
}  // namespace weir::page_buffer_test
