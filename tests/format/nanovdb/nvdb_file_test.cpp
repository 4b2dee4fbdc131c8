#include "format/nanovdb/nvdb_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "tests/stock/stock_nvdb.h"

namespace weir::nvdb_file_test {
namespace {

std::string message_at(const std::string& path) {
  try {
    const NvdbFile file(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no error";
}

std::string own_path() { return testing::TempDir() + "weir_nvdb_file_" + std::to_string(::getpid()) + ".nvdb"; }

TEST(NvdbFile, RefusesMissingEmptyAndForeignFiles) {
  EXPECT_EQ(message_at("/nonexistent/a.nvdb"), "/nonexistent/a.nvdb: cannot open: No such file or directory");
  EXPECT_EQ(message_at("/tmp"), "/tmp: not a regular file; give a .nvdb file");
  const std::string path = own_path();
  test::write_whole(path, {});
  EXPECT_EQ(message_at(path), path + ": the file is empty; give a .nvdb file");
  test::write_whole(path, std::vector<std::byte>(20));
  EXPECT_EQ(message_at(path), path + ": at byte 0: magic number 0x0 is not NanoVDB0 or NanoVDB2; not a NanoVDB file");
  std::remove(path.c_str());
}

TEST(NvdbFile, APipeIsRefusedAndNotWaitedFor) {
  const std::string path = own_path();
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(message_at(path), path + ": not a regular file; give a .nvdb file");
  std::remove(path.c_str());
}

TEST(NvdbFile, MovedFileKeepsItsGrid) {
  const std::string path = own_path();
  const test::StockNvdb sample(GridType::fpn);
  const auto bytes = sample.file();
  test::write_whole(path, bytes);
  NvdbFile file(path);
  EXPECT_EQ(file.bytes().size(), bytes.size());
  EXPECT_EQ(file.grid().value({1, 1, 1}), sample.value({1, 1, 1}));
  const NvdbFile moved = std::move(file);
  EXPECT_EQ(moved.grid().value({1, 1, 1}), sample.value({1, 1, 1}));
  EXPECT_EQ(moved.path(), path);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace weir::nvdb_file_test
