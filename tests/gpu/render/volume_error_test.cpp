#include "gpu/render/volume_error.h"

#include <gtest/gtest.h>

#include "tests/support/message_of_error.h"

namespace weir::volume_error_test {
namespace {

std::string said(ErrorKind kind, const Message& message) {
  return message_of_error(kind, [&] { naming_volume("a.nvdb", [&]() -> int { throw Error(kind, message); }); });
}

TEST(VolumeError, WithoutAnError_GivesWhatTheWorkGives) {
  EXPECT_EQ(naming_volume("a.nvdb", [] { return 7; }), 7);
}

TEST(VolumeError, MessageWithoutThePath_BeginsWithIt) {
  EXPECT_EQ(said(ErrorKind::usage, compose(option("memory", "1MiB"), " is too small")),
            "a.nvdb: --memory 1MiB is too small");
  EXPECT_EQ(said(ErrorKind::input, "the grid has no active voxel"), "a.nvdb: the grid has no active voxel");
}

TEST(VolumeError, MessageWithThePath_NamesItOnce) {
  EXPECT_EQ(said(ErrorKind::input, "a.nvdb: is damaged"), "a.nvdb: is damaged");
}

TEST(VolumeError, ErrorOfNoVolume_StaysAsItIs) {
  EXPECT_EQ(said(ErrorKind::interrupted, "interrupted"), "interrupted");
  EXPECT_EQ(said(ErrorKind::io, "b.png: cannot write"), "b.png: cannot write");
}

}  // namespace
}  // namespace weir::volume_error_test
