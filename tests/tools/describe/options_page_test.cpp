#include "tools/describe/options_page.h"

#include <gtest/gtest.h>

#include "tests/support/run_command.h"

namespace weir::options_page_test {
namespace {

TEST(OptionsPage, IsTheOneInDocs) {
  EXPECT_EQ(read_file(std::string(WEIR_SOURCE_DIR) + "/docs/options.md"), options_page())
      << "write it anew: weir man --options > docs/options.md";
}

TEST(OptionsPage, NamesAnOptionInEveryWay) {
  EXPECT_NE(
      options_page().find("| `--max-error` `ABS` | `max_error` | the values' |  | the smallest file in which every "
                          "voxel is within that of its value as float32, checked on decoded values |\n"),
      std::string::npos);
}

}  // namespace
}  // namespace weir::options_page_test
