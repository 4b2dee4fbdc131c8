#include "format/remote/fetched_bytes.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "format/base/error.h"

namespace weir {
namespace {

std::byte byte_at(std::uint64_t offset) { return static_cast<std::byte>((offset * 7 + 1) % 251); }

/// A file of which each byte says where it is, and what was asked of it.
struct RemoteFile {
  std::vector<ByteRange> asked;
  bool broken = false;

  RangeReader reader() {
    return [this](std::span<const ByteRange> ranges, std::span<const std::span<std::byte>> into) {
      if (broken) throw Error(ErrorKind::io, "the connection broke");
      for (std::size_t i = 0; i < ranges.size(); ++i) {
        asked.push_back(ranges[i]);
        for (std::uint64_t b = 0; b < ranges[i].bytes; ++b) into[i][b] = byte_at(ranges[i].offset + b);
      }
    };
  }
};

bool holds_file(const FetchedBytes& file, const ByteRange& range) {
  for (std::uint64_t at = range.offset; at < range.end(); ++at) {
    if (file.bytes()[at] != byte_at(at)) return false;
  }
  return true;
}

TEST(FetchedBytes, ReadsWhatIsAskedForAndNothingTwice) {
  RemoteFile remote;
  FetchedBytes file(1 << 20, remote.reader());
  file.fetch({{1000, 500}, {5000, 10}});
  EXPECT_TRUE(holds_file(file, {1000, 500}));
  EXPECT_EQ(file.bytes()[999], std::byte{0});
  EXPECT_EQ(file.held(), 510U);
  file.fetch({{1200, 100}});
  EXPECT_EQ(remote.asked, (std::vector<ByteRange>{{1000, 500}, {5000, 10}}));
  file.fetch({{900, 200}, {1400, 200}});
  EXPECT_EQ(remote.asked.size(), 4U);
  EXPECT_EQ(remote.asked[2], (ByteRange{900, 100}));
  EXPECT_EQ(remote.asked[3], (ByteRange{1500, 100}));
  EXPECT_TRUE(file.has({900, 700}));
  EXPECT_FALSE(file.has({900, 701}));
}

TEST(FetchedBytes, AFailedReadKeepsWhatWasThere) {
  RemoteFile remote;
  FetchedBytes file(1 << 20, remote.reader());
  file.fetch({{0, 100}});
  remote.broken = true;
  EXPECT_THROW(file.fetch({{50, 100}}), Error);
  EXPECT_TRUE(file.has({0, 100}));
  EXPECT_FALSE(file.has({50, 100}));
}

TEST(FetchedBytes, ForgetsFromAByteOn) {
  RemoteFile remote;
  FetchedBytes file(1 << 20, remote.reader());
  file.fetch({{0, 10000}, {300000, 5000}});
  file.forget_from(4097);
  EXPECT_TRUE(file.has({0, 4097}) && holds_file(file, {0, 4097}));
  EXPECT_FALSE(file.has({0, 4098}));
  EXPECT_EQ(file.held(), 4097U);
  EXPECT_EQ(file.bytes()[4097], std::byte{0});
  EXPECT_EQ(file.bytes()[9999], std::byte{0});
  EXPECT_EQ(file.bytes()[300001], std::byte{0});
  file.fetch({{300000, 5000}});
  EXPECT_TRUE(holds_file(file, {300000, 5000}));
  file.forget_from(1 << 20);
  EXPECT_EQ(file.held(), 9097U);
}

TEST(FetchedBytes, AgreesWithASetOfBytesWhateverIsAskedFor) {
  constexpr std::uint64_t kBytes = 3000;
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    RemoteFile remote;
    FetchedBytes file(kBytes, remote.reader());
    std::vector<bool> there(kBytes);
    for (int step = 0; step < 20; ++step) {
      const std::uint64_t offset = random() % kBytes;
      const ByteRange range{offset, random() % (kBytes - offset) % 400};
      file.fetch({range});
      std::fill_n(there.begin() + static_cast<std::ptrdiff_t>(offset), range.bytes, true);
      ASSERT_EQ(file.held(), static_cast<std::uint64_t>(std::count(there.begin(), there.end(), true)));
      ASSERT_TRUE(file.has(range) && holds_file(file, range));
      const std::uint64_t probe = random() % (kBytes - 20);
      const auto from = there.begin() + static_cast<std::ptrdiff_t>(probe);
      ASSERT_EQ(file.has({probe, 20}), std::all_of(from, from + 20, [](bool b) { return b; }));
    }
  }
}

}  // namespace
}  // namespace weir
