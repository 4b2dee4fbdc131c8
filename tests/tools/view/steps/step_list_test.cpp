#include "tools/view/steps/step_list.h"

#include <gtest/gtest.h>

namespace weir::step_list_test {
namespace {

using Numbers = std::vector<std::size_t>;

TEST(StepList, NumbersStay_OrderIsNatural) {
  StepList steps({"s_9", "s_2"});
  EXPECT_EQ(steps.order(), (Numbers{1, 0}));
  EXPECT_TRUE(steps.update({"s_2", "s_9", "s_10", "s_1"}));
  EXPECT_EQ(steps.count(), 4U);
  EXPECT_EQ(steps.path(0), "s_9");
  EXPECT_EQ(steps.path(2), "s_10");
  EXPECT_EQ(steps.order(), (Numbers{3, 1, 0, 2}));
  EXPECT_EQ(steps.after(0), 2U);
  EXPECT_EQ(steps.after(2), std::nullopt);
  EXPECT_FALSE(steps.update({"s_1", "s_10", "s_2", "s_9"})) << "the same in another order";
}

TEST(StepList, StepThatIsGone_KeepsItsNumberForItsReturn) {
  StepList steps({"s_1", "s_2", "s_3"});
  EXPECT_TRUE(steps.update({"s_1", "s_3"}));
  EXPECT_EQ(steps.order(), (Numbers{0, 2}));
  EXPECT_EQ(steps.count(), 3U);
  EXPECT_EQ(steps.path(1), "s_2");
  EXPECT_EQ(steps.after(1), std::nullopt);
  EXPECT_TRUE(steps.update({"s_1", "s_2", "s_3"}));
  EXPECT_EQ(steps.order(), (Numbers{0, 1, 2}));
}

TEST(StepList, Names_LackTheFoldersThatAllLieIn) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(step_names({"/d/s_1", "/d/s_2"}), (Names{"s_1", "s_2"}));
  EXPECT_EQ(step_names({"/d/runA/out", "/d/runB/out"}), (Names{"runA/out", "runB/out"}));
  EXPECT_EQ(step_names({"/a/s", "/b/s"}), (Names{"a/s", "b/s"}));
  EXPECT_EQ(step_names({"runA/out", "/runB/out"}), (Names{"runA/out", "/runB/out"}));
  EXPECT_EQ(step_names({"s_1"}), Names{"s_1"});
  EXPECT_EQ(step_names({}), Names{});
  StepList steps({"runA/out"});
  EXPECT_EQ(steps.name(0), "out");
  EXPECT_TRUE(steps.update({"runA/out", "runB/out"}));
  EXPECT_EQ(steps.names(), (Names{"runA/out", "runB/out"}));
  EXPECT_EQ(steps.name(0), "runA/out");
}

TEST(StepList, NothingSeen_ChangesNothing) {
  StepList steps({"s_1"});
  EXPECT_FALSE(steps.update({}));
  EXPECT_EQ(steps.order(), Numbers{0});
}

}  // namespace
}  // namespace weir::step_list_test
