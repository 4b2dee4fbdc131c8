#include "gpu/image/colormap.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "format/base/error.h"

namespace weir::colormap_test {
namespace {

TEST(Colormap, GrayIsLinearInSrgb) {
  const auto gray = colormap("gray", 256);
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_NEAR(srgb_from_linear(gray[i].x), static_cast<float>(i) / 255, 1e-5F);
    EXPECT_EQ(gray[i].x, gray[i].z);
  }
}

TEST(Colormap, EndsAreControlPoints) {
  for (const std::string_view name : colormap_names()) {
    const auto map = colormap(name, 2);
    ASSERT_EQ(map.size(), 2U);
    for (const Float3& c : map) {
      EXPECT_TRUE(c.x >= 0 && c.x <= 1 && c.y >= 0 && c.y <= 1 && c.z >= 0 && c.z <= 1) << name;
    }
  }
  EXPECT_NEAR(srgb_from_linear(colormap("cool-warm", 3)[1].y), 221.0F / 255, 1e-5F);
}

// Colours of the published table, at 0, 32, 64, 100, 141, 180, 222 and 255 of its 256.
TEST(Colormap, MagmaAsPublished) {
  const auto magma = colormap("magma", 256);
  const std::vector<std::pair<std::size_t, Float3>> published{
      {0, {0.001462F, 0.000466F, 0.013866F}},   {32, {0.113094F, 0.065492F, 0.276784F}},
      {64, {0.316654F, 0.071690F, 0.485380F}},  {100, {0.537755F, 0.156894F, 0.506551F}},
      {141, {0.798608F, 0.247040F, 0.444848F}}, {180, {0.969680F, 0.446936F, 0.360311F}},
      {222, {0.997138F, 0.755190F, 0.522806F}}, {255, {0.987053F, 0.991438F, 0.749504F}},
  };
  for (const auto& [entry, srgb] : published) {
    EXPECT_NEAR(srgb_from_linear(magma[entry].x), srgb.x, 1.01F / 255) << entry;
    EXPECT_NEAR(srgb_from_linear(magma[entry].y), srgb.y, 1.01F / 255) << entry;
    EXPECT_NEAR(srgb_from_linear(magma[entry].z), srgb.z, 1.01F / 255) << entry;
  }
}

TEST(Colormap, UnknownNameListsTheNames) {
  try {
    colormap("jet", 2);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_STREQ(error.what(),
                 "unknown colormap \"jet\"; use one of gray, white, heat, cool-warm, dusk, ct, water, magma");
  }
}

TEST(Srgb, RoundTripAndClamp) {
  for (const float v : {0.0F, 0.001F, 0.0031308F, 0.2F, 0.5F, 1.0F}) {
    EXPECT_NEAR(linear_from_srgb(srgb_from_linear(v)), v, 1e-6F);
  }
  EXPECT_EQ(srgb_from_linear(-1), 0.0F);
  EXPECT_NEAR(srgb_from_linear(7), 1.0F, 1e-6F);
  EXPECT_NEAR(srgb_from_linear(0.214041F), 0.5F, 1e-5F);
}

}  // namespace
}  // namespace weir::colormap_test
