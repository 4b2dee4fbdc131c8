#include <cmath>

#include "compressor/scene_notice.h"

#include <gtest/gtest.h>

namespace weir::scene_notice_test {
namespace {

TEST(SceneNotice, SceneThatShowsNothing_IsSaidWithTheValuesThatThereAre) {
  Sidecar sidecar;
  sidecar.source.path = "a.raw";
  sidecar.value_range = {0, 0.997};
  EXPECT_EQ(scene_notice(sidecar, "a.nvdb").text(), "") << "without a scene";
  sidecar.visible = Sidecar::Visible{"none.toml", 3, 1536, {}, ""};
  EXPECT_EQ(scene_notice(sidecar, "a.nvdb").text(), "");
  sidecar.visible->blocks = 0;
  EXPECT_EQ(scene_notice(sidecar, "a.nvdb").text(),
            "a.nvdb: none.toml shows nothing of a.raw, whose values are from 0 to 0.997; correct its range, opacity or "
            "region, or leave out --scene");
  sidecar.value_range = {std::nan(""), std::nan("")};
  EXPECT_EQ(scene_notice(sidecar, "a.nvdb").text(),
            "a.nvdb: none.toml shows nothing of a.raw, no value of which is finite; correct its range, opacity or "
            "region, or leave out --scene");
}

}  // namespace
}  // namespace weir::scene_notice_test
