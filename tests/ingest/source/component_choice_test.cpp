#include "ingest/source/component_choice.h"

#include <gtest/gtest.h>

namespace weir::component_choice_test {
namespace {

TEST(ComponentChoice, NamesArePositions) {
  EXPECT_EQ(parse_component("x"), (ComponentChoice{false, 0}));
  EXPECT_EQ(parse_component("z"), (ComponentChoice{false, 2}));
  EXPECT_EQ(parse_component("8"), (ComponentChoice{false, 8}));
  EXPECT_EQ(parse_component("magnitude"), (ComponentChoice{true, 0}));
  for (const char* text : {"", "w", "xy", "-1", "64", "1.5", "Magnitude"})
    EXPECT_EQ(parse_component(text), std::nullopt);
}

TEST(ComponentChoice, TextReadsBack) {
  EXPECT_EQ(component_text({false, 2}), "2");
  EXPECT_EQ(component_text({true, 0}), "magnitude");
}

}  // namespace
}  // namespace weir::component_choice_test
