#include "compressor/describe_conversion.h"

#include <gtest/gtest.h>

#include <string>

namespace weir {
namespace {

TEST(GridName, IsTheDatasetsWhereTheFileCanHoldIt) {
  EXPECT_EQ(grid_name("fields/density"), "fields/density");
  EXPECT_EQ(grid_name("Dichte/\xC3\xBC"), "Dichte/\xC3\xBC");
  EXPECT_EQ(grid_name(std::string(255, 'n')), std::string(255, 'n'));
  EXPECT_EQ(grid_name(""), "density");
}

TEST(GridName, IsTheLastPartOrDensityWhereTheWholeIsTooLongOrNoUtf8) {
  EXPECT_EQ(grid_name(std::string(300, 'g') + "/density"), "density");
  EXPECT_EQ(grid_name(std::string(300, 'g') + "/Temp"), "Temp");
  EXPECT_EQ(grid_name(std::string(256, 'n')), "density");
  EXPECT_EQ(grid_name("Gr\xF6\xDF"
                      "e/Temp"),
            "Temp");
  EXPECT_EQ(grid_name("Temp/Gr\xF6\xDF"
                      "e"),
            "density");
  EXPECT_EQ(grid_name("cut \xE2\x82"), "density");
}

}  // namespace
}  // namespace weir
