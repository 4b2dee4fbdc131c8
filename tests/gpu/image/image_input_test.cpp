#include "gpu/image/image_input.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "format/base/error.h"
#include "gpu/image/image_output.h"
#include "gpu/scene/environment.h"
#include "tests/gpu/support/test_environment.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_directory.h"

namespace weir::image_input_test {
namespace {

const ImageSizeCheck kAny = [](std::int32_t, std::int32_t) {};

class ImageInput : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(directory_ / name, std::ios::binary) << bytes;
    return directory_ / name;
  }
  std::string write(const std::string& name, const Image& image) const {
    const std::vector<std::byte> bytes = encode_exr(image);
    return write(name, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }
  static std::string message(const std::string& path) {
    try {
      read_image(path, kAny);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
    return "no error";
  }

  TemporaryDirectory directory_;
};

TEST_F(ImageInput, ExrAsItWasWritten) {
  const Image image = test::surroundings(19, [](int x, int y) {
    return Float3{static_cast<float>(x) * 1e-20F, static_cast<float>(y) * -3.25e20F, kInfinity};
  });
  const Image read = read_image(write("a.exr", image), kAny);
  EXPECT_EQ(read.width, 38);
  EXPECT_EQ(read.height, 19);
  EXPECT_EQ(read.pixels, image.pixels);
}

TEST_F(ImageInput, HdrByItsFirstBytes) {
  const Image read = read_image(write("a.exr", "#?RGBE\n\n-Y 1 +X 1\n\x40\x20\x10\x80"), kAny);
  EXPECT_EQ(read.at(0, 0), (Float3{0.25F, 0.125F, 0.0625F}));
}

TEST_F(ImageInput, SizeIsCheckedBeforeThePixelsAreRead) {
  const std::string path = write("a.exr", Image(6, 3));
  try {
    read_image(path, [](std::int32_t width, std::int32_t height) {
      EXPECT_EQ(width, 6);
      EXPECT_EQ(height, 3);
      throw Error(ErrorKind::input, "not this one");
    });
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "not this one");
  }
}

TEST_F(ImageInput, Errors) {
  EXPECT_NE(message(directory_ / "no.exr").find("no.exr: "), std::string::npos);
  const std::string text = write("a.png", "\x89PNG");
  EXPECT_EQ(message(text), text + ": neither OpenEXR nor Radiance; give an .exr or .hdr file");
  const std::string empty = write("a.hdr", "");
  EXPECT_EQ(message(empty), empty + ": the file is empty; give a .exr or .hdr file");
}

// A truncated or changed file gives an error or a picture, never a crash.
TEST_F(ImageInput, BrokenExr) {
  const LeaksOfLibraries of_tinyexr;
  const std::vector<std::byte> bytes = encode_exr(test::surroundings(40, [](int x, int y) {
    return Float3{static_cast<float>(x * 7919 % 101), static_cast<float>(y), 1};
  }));
  const std::string whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (std::size_t length = 4; length < whole.size(); length += 1 + length / 8) {
    const std::string path = write("cut.exr", whole.substr(0, length));
    const std::string reason = message(path);
    EXPECT_TRUE(reason.starts_with(path + ": broken OpenEXR file (")) << length << ' ' << reason;
    EXPECT_EQ(reason.find('\n'), std::string::npos);
  }
}

TEST_F(ImageInput, LoadsASceneEnvironment) {
  Scene scene;
  EXPECT_EQ(load_environment(scene), nullptr);
  scene.lighting.environment = write("sky.exr", test::surroundings(8, [](int x, int) {
                                       return Float3{static_cast<float>(x), 1, 2};
                                     }));
  scene.lighting.environment_scale = 4;
  scene.lighting.environment_rotation = 90;
  const auto environment = load_environment(scene);
  ASSERT_NE(environment, nullptr);
  EXPECT_EQ(environment->view().at({0.01F, 1, 0}), (Float3{32, 4, 8}));
  scene.lighting.environment = write("wide.exr", Image(6, 2));
  EXPECT_THROW(load_environment(scene), Error);
}

}  // namespace
}  // namespace weir::image_input_test
