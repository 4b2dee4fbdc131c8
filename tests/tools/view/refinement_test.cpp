#include "tools/view/refinement.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace weir::refinement_test {
namespace {

Image filled(const FrameSize& size, float value) {
  Image image(size.width, size.height);
  for (Float3& pixel : image.pixels) pixel = {value, value, value};
  return image;
}

TEST(Refinement, GrowsThenTakesSamples) {
  Refinement refinement(64, 48, 1, 0.25, 16);
  std::vector<FrameSize> sizes;
  std::vector<std::uint32_t> shown;
  std::set<std::uint64_t> seeds;
  while (const auto pass = refinement.next()) {
    refinement.add(*pass, {filled(pass->size, 1)});
    sizes.push_back(pass->size);
    const bool other = !pass->whole || seeds.insert(pass->seed).second;
    EXPECT_TRUE(other) << "the same random numbers twice";
    if (pass->shown && pass->whole) shown.push_back(refinement.samples());
  }
  EXPECT_EQ(sizes[0], (FrameSize{16, 12, 1}));
  EXPECT_EQ(sizes[1], (FrameSize{32, 24, 1}));
  EXPECT_EQ(sizes[2], (FrameSize{64, 48, 1}));
  EXPECT_EQ(shown, (std::vector<std::uint32_t>{1, 2, 4, 8, 16}));
  EXPECT_EQ(refinement.samples(), 16U);
}

TEST(Refinement, PictureIsTheMeanOfAllSamples) {
  Refinement refinement(4, 2, 1, 1, 4);
  for (const float value : {1.0F, 3.0F, 8.0F}) {
    const auto pass = refinement.next();
    ASSERT_TRUE(pass);
    refinement.add(*pass, {filled(pass->size, value)});
  }
  // 1, 1 and 2 samples a pixel.
  EXPECT_FALSE(refinement.next());
  EXPECT_FLOAT_EQ(refinement.picture().at(3, 1).x, (1.0F + 3.0F + 2 * 8.0F) / 4);
}

TEST(Refinement, LayersAreAboveEachOther) {
  Refinement refinement(4, 2, 2, 1, 1);
  const auto pass = refinement.next();
  ASSERT_TRUE(pass);
  refinement.add(*pass, {filled(pass->size, 1), filled(pass->size, 2)});
  const Image picture = refinement.picture();
  EXPECT_EQ(picture.width, 4);
  EXPECT_EQ(picture.height, 4);
  EXPECT_EQ(picture.at(0, 1).x, 1);
  EXPECT_EQ(picture.at(0, 2).x, 2);
}

TEST(Refinement, APassLeftOut_IsAskedForAgain) {
  const Refinement refinement(64, 48, 1, 1, 16);
  EXPECT_EQ(refinement.next()->seed, refinement.next()->seed);
}

TEST(Refinement, OfNothing_IsDone) { EXPECT_FALSE(Refinement().next()); }

}  // namespace
}  // namespace weir::refinement_test
