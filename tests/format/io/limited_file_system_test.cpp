#include "format/io/limited_file_system.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/temporary_directory.h"

namespace weir::limited_file_system_test {
namespace {

using namespace std::chrono_literals;

TEST(LimitedFileSystem, ReadsAndWritesAreThrottledAndBytesUnchanged) {
  const TokenBucket::Time start = TokenBucket::Time() + 1000h;
  TokenBucket::Time now = start;
  Bandwidth bandwidth(1000, nullptr, {[&] { return now; }, [&](auto time) { now += time; }});
  const TemporaryDirectory directory;
  const auto real = make_posix_file_system();
  const auto files = limit_file_system(*real, bandwidth);
  const std::array<std::byte, 600> bytes{std::byte{7}, std::byte{8}};
  std::array<std::byte, 600> back{};

  const auto named = files->create(directory / "a");
  named->preallocate(600);  // moves nothing
  EXPECT_EQ(now, start);
  named->write_at(0, bytes);
  EXPECT_EQ(now, start + 500ms);  // 100 were free
  named->read_at(0, back);
  EXPECT_EQ(now, start + 1100ms);
  EXPECT_EQ(back, bytes);
  EXPECT_TRUE(named->has_its_name());
  files->remove(directory / "a");
  EXPECT_FALSE(named->has_its_name());
  const auto unnamed = files->create_unnamed(directory.path().string());
  unnamed->write_at(0, bytes);
  EXPECT_EQ(now, start + 1700ms);
}

}  // namespace
}  // namespace weir::limited_file_system_test
