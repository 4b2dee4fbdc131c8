#include "ingest/plan/page_buffer.h"

#include <algorithm>
#include <cstdint>

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

TEST(PageBuffer, RefusedMemoryIsAnError) {
  EXPECT_EQ(message_of_error(ErrorKind::io, [] { PageBuffer(std::size_t{1} << 62U); }),
            "memory: cannot get 4611686018427387904 bytes for reading; lower --memory: Cannot allocate memory");
}

}  // namespace
}  // namespace weir::page_buffer_test
