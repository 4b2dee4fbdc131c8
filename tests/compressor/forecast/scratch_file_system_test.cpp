#include "compressor/forecast/scratch_file_system.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>

#include "format/output/output_files.h"
#include "tests/support/message_of_error.h"
#include "tests/support/run_command.h"

namespace weir::scratch_file_system_test {
namespace {

class ScratchFileSystemTest : public testing::Test {
 protected:
  TemporaryDirectory directory_;
  std::string output_ = directory_ / "out.nvdb";
  std::unique_ptr<FileSystem> real_ = make_posix_file_system();
  ScratchFileSystem files_{*real_, output_};
};

TEST_F(ScratchFileSystemTest, WholeOutput_LeavesTheDirectoryAsItWas) {
  const std::array<std::byte, 4> bytes{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}};
  {
    OutputFiles output(files_, output_, false);
    output.reserve(100);
    output.volume().write_at(0, bytes);
    EXPECT_EQ(output.volume().size(), 100U);
    EXPECT_TRUE(list_directory(directory_.path()).empty());
    output.commit("{}");
  }
  EXPECT_TRUE(files_.exists(output_));
  EXPECT_TRUE(list_directory(directory_.path()).empty());
}

TEST_F(ScratchFileSystemTest, ExistingOutput_IsRefusedAsByAConversion) {
  write_file(output_, "somebody's");
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { OutputFiles(files_, output_, false); }),
            output_ + ": exists; choose another output or pass --overwrite");
  OutputFiles(files_, output_, true).commit("{}");
  EXPECT_EQ(read_file(output_), "somebody's");
}

TEST_F(ScratchFileSystemTest, WhatAnotherConversionKeepsBesideIt_IsNotShown) {
  write_file(output_ + ".partial", "half");
  std::filesystem::create_directory(directory_ / ".out.nvdb.work");
  EXPECT_FALSE(files_.exists(output_ + ".partial"));
  EXPECT_FALSE(files_.exists(directory_ / ".out.nvdb.work"));
  OutputFiles(files_, output_, false).commit("{}");
  EXPECT_EQ(read_file(output_ + ".partial"), "half");
}

}  // namespace
}  // namespace weir::scratch_file_system_test
