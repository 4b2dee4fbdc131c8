#include "format/io/output_names.h"

#include <gtest/gtest.h>

namespace weir {
namespace {

TEST(DirectoryOf, IsThePathBeforeTheLastSlash) {
  EXPECT_EQ(directory_of("a/b/c.nvdb"), "a/b");
  EXPECT_EQ(directory_of("c.nvdb"), ".");
  EXPECT_EQ(directory_of("/c.nvdb"), "/");
}

}  // namespace
}  // namespace weir
