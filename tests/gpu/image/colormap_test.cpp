#include "gpu/image/colormap.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/sidecar/colormap_names.h"

namespace weir::colormap_test {
namespace {

TEST(Colormap, GrayIsLinearInSrgb) {
  const auto gray = colormap("gray", 256);
  for (std::size_t i = 0; i < 256; ++i) {
    EXPECT_NEAR(srgb_from_linear(gray[i].x), static_cast<float>(i) / 255, 1e-5F);
    EXPECT_EQ(gray[i].x, gray[i].z);
  }
}

TEST(Colormap, EachNameThatASceneMayGiveHasColours) {
  std::string names;
  for (const std::string_view name : colormap_names()) names += cat(names.empty() ? "" : "|", name);
  EXPECT_EQ(names, kColormapNames);
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

// Colours of the published tables, at 0, 32, 64, 100, 141, 180, 222 and 255 of their 256.
TEST(Colormap, PerceptualMapsAsPublished) {
  using Colours = std::vector<std::pair<std::size_t, Float3>>;
  const std::vector<std::pair<std::string_view, Colours>> published{
      {"magma",
       {{0, {0.001462F, 0.000466F, 0.013866F}},
        {32, {0.113094F, 0.065492F, 0.276784F}},
        {64, {0.316654F, 0.071690F, 0.485380F}},
        {100, {0.537755F, 0.156894F, 0.506551F}},
        {141, {0.798608F, 0.247040F, 0.444848F}},
        {180, {0.969680F, 0.446936F, 0.360311F}},
        {222, {0.997138F, 0.755190F, 0.522806F}},
        {255, {0.987053F, 0.991438F, 0.749504F}}}},
      {"viridis",
       {{0, {0.267004F, 0.004874F, 0.329415F}},
        {32, {0.278826F, 0.175490F, 0.483397F}},
        {64, {0.229739F, 0.322361F, 0.545706F}},
        {100, {0.166617F, 0.463708F, 0.558119F}},
        {141, {0.119483F, 0.614817F, 0.537692F}},
        {180, {0.274149F, 0.751988F, 0.436601F}},
        {222, {0.657642F, 0.860219F, 0.203082F}},
        {255, {0.993248F, 0.906157F, 0.143936F}}}},
      {"plasma",
       {{0, {0.050383F, 0.029803F, 0.527975F}},
        {32, {0.299855F, 0.009561F, 0.631624F}},
        {64, {0.494877F, 0.011990F, 0.657865F}},
        {100, {0.683758F, 0.156278F, 0.571660F}},
        {141, {0.843484F, 0.338062F, 0.424013F}},
        {180, {0.951344F, 0.522850F, 0.292275F}},
        {222, {0.993851F, 0.759304F, 0.159092F}},
        {255, {0.940015F, 0.975158F, 0.131326F}}}},
      {"inferno",
       {{0, {0.001462F, 0.000466F, 0.013866F}},
        {32, {0.129285F, 0.047293F, 0.290788F}},
        {64, {0.341500F, 0.062325F, 0.429425F}},
        {100, {0.565854F, 0.143567F, 0.408258F}},
        {141, {0.807082F, 0.262692F, 0.278898F}},
        {180, {0.956852F, 0.475356F, 0.094695F}},
        {222, {0.977497F, 0.782258F, 0.185923F}},
        {255, {0.988362F, 0.998364F, 0.644924F}}}},
      {"cividis",
       {{0, {0.000000F, 0.135112F, 0.304751F}},
        {32, {0.103401F, 0.220406F, 0.435790F}},
        {64, {0.263738F, 0.307831F, 0.422789F}},
        {100, {0.394568F, 0.406236F, 0.438986F}},
        {141, {0.536553F, 0.523067F, 0.472352F}},
        {180, {0.687957F, 0.641966F, 0.442886F}},
        {222, {0.862105F, 0.782494F, 0.350011F}},
        {255, {0.995737F, 0.909344F, 0.217772F}}}},
  };
  for (const auto& [name, colours] : published) {
    const std::vector<Float3> map = colormap(name, 256);
    for (const auto& [entry, srgb] : colours) {
      EXPECT_NEAR(srgb_from_linear(map[entry].x), srgb.x, 1.01F / 255) << name << ' ' << entry;
      EXPECT_NEAR(srgb_from_linear(map[entry].y), srgb.y, 1.01F / 255) << name << ' ' << entry;
      EXPECT_NEAR(srgb_from_linear(map[entry].z), srgb.z, 1.01F / 255) << name << ' ' << entry;
    }
  }
}

TEST(Colormap, UnknownNameListsTheNames) {
  try {
    colormap("jet", 2);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_STREQ(error.what(),
                 "unknown colormap \"jet\"; use one of gray, white, heat, cool-warm, dusk, ct, water, magma, "
                 "viridis, plasma, inferno, cividis");
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
