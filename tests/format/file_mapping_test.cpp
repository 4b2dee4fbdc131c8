#include "format/file_mapping.h"

#include <gtest/gtest.h>

#include <fstream>
#include <utility>

#include "format/error.h"
#include "tests/support/temporary_directory.h"

namespace weir {
namespace {

std::string refusal(const std::string& path) {
  try {
    const FileMapping mapping(path, ".nvdb");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return {};
}

TEST(FileMapping, BytesOutliveMovesAndReleasedPages) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "a") << "bytes";
  FileMapping first(directory / "a", ".nvdb");
  const FileMapping mapping(std::move(first));
  const std::byte* const at = mapping.bytes().data();
  ASSERT_EQ(mapping.bytes().size(), 5U);
  EXPECT_EQ(mapping.bytes()[4], std::byte{'s'});
  mapping.release_pages();
  EXPECT_EQ(mapping.bytes().data(), at);
  EXPECT_EQ(mapping.bytes()[0], std::byte{'b'});
}

TEST(FileMapping, SaysWhatCannotBeMapped) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "empty").close();
  EXPECT_EQ(refusal(directory / "none"), directory / "none" + ": cannot open: No such file or directory");
  EXPECT_EQ(refusal(directory / "empty"), directory / "empty" + ": the file is empty; give a .nvdb file");
  EXPECT_EQ(refusal(directory.path().string()), directory.path().string() + ": not a regular file; give a .nvdb file");
}

}  // namespace
}  // namespace weir
