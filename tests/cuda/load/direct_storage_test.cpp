// What is said of a read of cuFile that brought nothing.
#include <gtest/gtest.h>

#include <cerrno>

#include "gpu/cuda/load/cufile.h"

namespace weir::direct_storage_test {
namespace {

TEST(DirectStorage, ReadAtTheEndOfTheFile_SaysWhereItEnds) {
  EXPECT_EQ(cufile::read_failure(0, 4096), "the file ends at byte 4096");
}

TEST(DirectStorage, FailedRead_SaysTheErrorOfTheSystemOrOfCuFile) {
  errno = EIO;
  EXPECT_EQ(cufile::read_failure(-1, 0), "Input/output error");
  EXPECT_EQ(cufile::read_failure(-5027, 0), "cuFile error 5027");
}

}  // namespace
}  // namespace weir::direct_storage_test
