// Tests which names of datasets are suggested for a name that the file does not have.
#include "ingest/hdf5/meaning/hdf5_lookup.h"

#include <gtest/gtest.h>

namespace weir::near_names_test {
namespace {

using Names = std::vector<std::string>;

TEST(NearNames, FindsNamesOfOtherCasePathOrSpelling) {
  const Names names{"/a/Density", "/b/density", "/b/temperature", "/x", "/y", "/velocity_x", "/velocity_y"};
  EXPECT_EQ(near_names("density", names, 8), (Names{"/a/Density", "/b/density"}));
  EXPECT_EQ(near_names("/c/DENSITY", names, 1), (Names{"/a/Density"}));
  EXPECT_EQ(near_names("/b/tempreature", names, 8), (Names{"/b/temperature"}));
  EXPECT_EQ(near_names("/velocity_z", names, 8), (Names{"/velocity_x", "/velocity_y"}));
  EXPECT_EQ(near_names("/velocityx", names, 8), (Names{"/velocity_x", "/velocity_y"}));
  EXPECT_EQ(near_names("/z", names, 8), Names{});  // every one-letter name is equally near
  EXPECT_EQ(near_names("/pressure", names, 8), Names{});
  EXPECT_EQ(near_names("", names, 8), Names{});
}

}  // namespace
}  // namespace weir::near_names_test
