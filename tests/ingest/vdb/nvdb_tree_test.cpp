#include "ingest/vdb/nvdb_tree.h"

#include <algorithm>
#include <fstream>

#include "tests/ingest/scratch.h"

namespace weir {
namespace {

/// Resident bytes of file mappings of this process.
std::uint64_t resident_file_bytes() {
  std::ifstream status("/proc/self/status");
  std::string word;
  std::uint64_t kib = 0;
  while (status >> word) {
    if (word == "RssFile:") status >> kib;
  }
  return kib * 1024;
}

TEST(MappedPages, StayBelowTheirLimit) {
  const Scratch scratch;
  constexpr std::size_t kBytes = std::size_t{160} << 20U;
  const FileMapping mapping(scratch.write("a", std::vector<std::byte>(kBytes, std::byte{1})), ".nvdb");
  MappedPages pages(mapping);
  const std::uint64_t before = resident_file_bytes();
  std::uint64_t most = 0;
  unsigned sum = 0;
  for (std::size_t at = 0; at < kBytes; at += 2048) {
    const std::byte* const leaf = mapping.bytes().data() + at;
    pages.touch(leaf, 2048);
    sum += std::to_integer<unsigned>(*leaf);
    if (at % (std::size_t{4} << 20U) == 0) most = std::max(most, resident_file_bytes());
  }
  EXPECT_EQ(sum, kBytes / 2048);
  EXPECT_GT(most, before) << "the mapping is never resident: nothing was tested";
  EXPECT_LE(most, before + MappedPages::kLimit + (std::uint64_t{4} << 20U));
}

}  // namespace
}  // namespace weir
