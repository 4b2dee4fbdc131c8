#include "ingest/plan/for_pieces.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace weir::for_pieces_test {
namespace {

TEST(ForPieces, EachPieceOnce) {
  for (const std::size_t threads : {1U, 2U, 7U, 100U}) {
    std::vector<std::atomic<int>> seen(50);
    for_pieces(50, threads, [&](std::int64_t i) { ++seen[static_cast<std::size_t>(i)]; });
    for (const auto& times : seen) EXPECT_EQ(times, 1);
  }
}

TEST(ForPieces, NoPieces) {
  for_pieces(0, 4, [](std::int64_t) { FAIL(); });
}

TEST(ForPieces, OneThreadIsTheCallingOne) {
  const auto caller = std::this_thread::get_id();
  std::int64_t next = 0;
  for_pieces(9, 1, [&](std::int64_t i) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(i, next++);
  });
  EXPECT_EQ(next, 9);
}

TEST(ForPieces, ExceptionStopsTheRestAndIsRethrown) {
  for (const std::size_t threads : {1U, 4U}) {
    std::atomic<int> calls{0};
    EXPECT_THROW(for_pieces(1'000'000, threads,
                            [&](std::int64_t i) {
                              ++calls;
                              if (i == 5) throw std::domain_error("five");
                            }),
                 std::domain_error);
    EXPECT_LT(calls, 1'000'000);
  }
}

}  // namespace
}  // namespace weir::for_pieces_test
