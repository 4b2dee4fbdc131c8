#include "ingest/source/source_files.h"

#include <gtest/gtest.h>

#include "tests/support/run_command.h"

namespace weir::source_files_test {
namespace {

TEST(SourceFileIds, AreThoseOfTheFilesThatExistAndOfThePath) {
  const TemporaryDirectory directory;
  SourceInfo info;
  info.path = directory / "a.nhdr";
  write_file(info.path, "header");
  FileState data;
  data.path = directory / "a.raw";
  data.exists = true;
  data.device = 7;
  data.inode = 9;
  FileState missing = data;
  missing.inode = 10;
  missing.exists = false;
  info.files = {data, missing};
  EXPECT_EQ(source_file_ids(info), (std::vector<FileId>{{7, 9}, file_id(info.path).value()}));
}

TEST(SourceFileIds, OfAnArrayInMemory_AreNone) {
  SourceInfo info;
  info.path = "density";
  EXPECT_EQ(source_file_ids(info), std::vector<FileId>{});
}

}  // namespace
}  // namespace weir::source_files_test
