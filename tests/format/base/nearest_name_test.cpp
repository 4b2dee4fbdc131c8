#include "format/base/nearest_name.h"

#include <gtest/gtest.h>

namespace weir::nearest_name_test {
namespace {

const std::vector<std::string> kNames{"convert", "compare", "render", "verify", "--rate", "--roi"};

TEST(NearestName, OneSlip_FindsTheName) {
  for (const char* word : {"covnert", "convrt", "convertt", "conxert"})
    EXPECT_EQ(nearest_name(word, kNames), "convert");
}

TEST(NearestName, OneSlipInThreeLetters_IsTheMost) {
  EXPECT_EQ(nearest_name("rendxy", kNames), "render");
  EXPECT_EQ(nearest_name("renxyz", kNames), "");
  EXPECT_EQ(nearest_name("", kNames), "");
  EXPECT_EQ(nearest_name("ls", kNames), "");
}

TEST(NearestName, OfSeveral_TakesTheFewestSlips) { EXPECT_EQ(nearest_name("--rote", kNames), "--rate"); }

}  // namespace
}  // namespace weir::nearest_name_test
