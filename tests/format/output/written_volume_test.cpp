#include "format/output/written_volume.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "format/base/error.h"
#include "format/io/memory_file_system.h"
#include "tests/stock/stock_nvdb.h"
#include "tests/support/temporary_directory.h"

namespace weir::written_volume_test {
namespace {
std::string message_of(const File& file) {
  try {
    const WrittenVolume volume(file);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::io);
    return error.what();
  }
  return "no error";
}

TEST(WrittenVolume, IsReadWhereItLies) {
  const test::StockNvdb sample(GridType::fpn);
  const auto bytes = sample.file();
  const TemporaryDirectory directory;
  const auto disk = make_posix_file_system();
  MemoryFileSystem memory;
  std::vector<std::unique_ptr<File>> files;
  files.push_back(disk->create(directory / "a.nvdb.partial"));
  files.push_back(memory.create("a.nvdb.partial"));
  for (const auto& file : files) {
    file->write_at(0, bytes);
    const WrittenVolume volume(*file);
    EXPECT_EQ(volume.grid().value({1, 1, 1}), sample.value({1, 1, 1}));
    volume.release_pages();
    EXPECT_EQ(volume.grid().value({1, 1, 1}), sample.value({1, 1, 1}));
    EXPECT_EQ(volume.grid().bytes().data() == file->memory().data(), !file->memory().empty());
  }
}

TEST(WrittenVolume, IsReadWhateverHasItsPath) {
  const test::StockNvdb sample(GridType::fpn);
  const TemporaryDirectory directory;
  const auto disk = make_posix_file_system();
  const auto file = disk->create(directory / "a.nvdb.partial");
  file->write_at(0, sample.file());
  disk->rename(directory / "a.nvdb.partial", directory / "b.nvdb");
  EXPECT_EQ(WrittenVolume(*file).grid().value({1, 1, 1}), sample.value({1, 1, 1}));
  disk->create(directory / "a.nvdb.partial")->write_at(0, std::vector<std::byte>(20));
  EXPECT_EQ(WrittenVolume(*file).grid().value({1, 1, 1}), sample.value({1, 1, 1}));
  EXPECT_FALSE(message_of(*disk->open(directory / "a.nvdb.partial")).empty());
  file->write_at(0, sample.file());  // its descriptor is open still
}

TEST(WrittenVolume, WhatCannotBeReadBackIsAFaultOfTheDisk) {
  MemoryFileSystem memory;
  const auto file = memory.create("a.nvdb.partial");
  file->write_at(0, std::vector<std::byte>(20));
  EXPECT_EQ(message_of(*file),
            "a.nvdb.partial: at byte 0: magic number 0x0 is not NanoVDB0 or NanoVDB2; not a NanoVDB file; it was "
            "written just now, check the disk");
}

}  // namespace
}  // namespace weir::written_volume_test
