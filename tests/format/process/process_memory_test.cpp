#include "format/process/process_memory.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "format/io/memory_file_system.h"

namespace weir::process_memory_test {
namespace {

TEST(ProcessMemory, ResidentBytesGrowWithAnAllocation) {
  const std::uint64_t before = resident_bytes();
  constexpr std::size_t kTaken = std::size_t{64} << 20U;
  const std::vector<char> taken(kTaken, 1);
  EXPECT_EQ(taken[kTaken / 2], 1);
  const std::uint64_t resident = resident_bytes();
  EXPECT_GE(resident, before + kTaken - (1U << 20U));
  EXPECT_GE(peak_resident_bytes(), resident);
}

TEST(ProcessMemory, AvailableBytesArePlausible) {
  EXPECT_GT(available_bytes(), std::uint64_t{1} << 20U);
  EXPECT_LT(available_bytes(), std::uint64_t{1} << 50U);
}

TEST(ProcessMemory, PagesThatAreMadeAreResidentAndKeepTheirBytes) {
  constexpr std::size_t kBytes = std::size_t{64} << 20U;
  MemoryFileSystem files;
  const std::unique_ptr<File> file = files.create("pages");
  file->preallocate(kBytes);
  const std::array<std::byte, 1> written{std::byte{7}};
  file->write_at(kBytes / 2, written);
  const std::uint64_t before = resident_bytes();
  make_pages(file->memory());
  EXPECT_GE(resident_bytes(), before + kBytes - (4U << 20U));
  EXPECT_EQ(file->memory()[kBytes / 2], std::byte{7});
  EXPECT_EQ(file->memory()[0], std::byte{0});
}

}  // namespace
}  // namespace weir::process_memory_test
