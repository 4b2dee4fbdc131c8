#include "ingest/source/left_out.h"

#include <gtest/gtest.h>

namespace weir::left_out_test {
namespace {

DatasetInfo refused(std::vector<std::int64_t> extents) {
  DatasetInfo dataset;
  dataset.extents = std::move(extents);
  dataset.obstacle = "its type is text";
  return dataset;
}

TEST(LeftOut, VolumesWithAnObstacle_AreUnread) {
  EXPECT_TRUE(is_unread_volume(refused({2, 3, 4})));
  EXPECT_TRUE(is_unread_volume(refused({5, 2, 3, 4})));
  EXPECT_FALSE(is_unread_volume(refused({3, 4}))) << "coordinates";
  DatasetInfo over_time = refused({2, 3, 4});
  over_time.over_time = true;
  EXPECT_FALSE(is_unread_volume(over_time));
  DatasetInfo by_name_only = refused({2, 3, 4});
  by_name_only.by_name_only = true;
  EXPECT_FALSE(is_unread_volume(by_name_only));
  DatasetInfo readable = refused({2, 3, 4});
  readable.obstacle.clear();
  EXPECT_FALSE(is_unread_volume(readable));
}

TEST(LeftOut, Notice_NamesThreeAndCountsTheOthers) {
  const std::vector<LeftOut> all{{"a", "A"}, {"b", "B"}, {"c", "C"}, {"d", "D"}, {"e", "E"}};
  EXPECT_EQ(left_out_notice("x.h5", "/v", std::span(all).first(1)).text(), "x.h5: /v is read; left out: a: A");
  EXPECT_EQ(left_out_notice("x.h5", "/v", std::span(all).first(3)).text(),
            "x.h5: /v is read; left out: a: A; b: B; c: C");
  EXPECT_EQ(left_out_notice("x.h5", "/v", all).text(),
            "x.h5: /v is read; left out: a: A; b: B; c: C; and 2 more (weir inspect lists them)");
}

}  // namespace
}  // namespace weir::left_out_test
