#include "format/base/error.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <string>

namespace weir::error_test {
namespace {

TEST(Error, Reason_HasNoPlaceBeforeIt) {
  EXPECT_EQ(reason_of(input_error("a.h5: /v", "is damaged"), "a.h5: /v"), "is damaged");
  EXPECT_EQ(reason_of(input_error("a.h5.part", "is damaged"), "a.h5"), "a.h5.part: is damaged");
}

TEST(Error, PathThatTheSystemRefuses_IsSaidWithItsRemedy) {
  const auto said = [](int errno_value) { return std::string(io_error("a/b", "create", errno_value).what()); };
  EXPECT_EQ(said(ENOTDIR), "a/b: cannot create: Not a directory; correct the path, a part of which is a file");
  EXPECT_EQ(said(ELOOP),
            "a/b: cannot create: Too many levels of symbolic links; correct the symbolic links of its path, which lead "
            "in a circle");
  EXPECT_EQ(said(ENAMETOOLONG), "a/b: cannot create: File name too long; choose a shorter name");
}

TEST(Error, LimitOfTheSystem_IsSaidWithItsRemedy) {
  const auto said = [](int errno_value) { return std::string(io_error("a/b", "create", errno_value).what()); };
  EXPECT_EQ(said(EMFILE), "a/b: cannot create: Too many open files; raise the limit of open files (ulimit -n)");
  EXPECT_EQ(said(ENFILE),
            "a/b: cannot create: Too many open files in system; raise the limit of open files (ulimit -n)");
  EXPECT_EQ(said(EFBIG),
            "a/b: cannot create: File too large; raise the limit of file size (ulimit -f) or choose another file "
            "system");
}

}  // namespace
}  // namespace weir::error_test
