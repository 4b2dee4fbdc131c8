#include "gpu/image/image_output.h"

#include <gtest/gtest.h>
#include <png.h>
#include <tinyexr.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "format/base/error.h"

namespace weir::image_output_test {
namespace {

namespace fs = std::filesystem;

class ImageOutput : public testing::Test {
 protected:
  ImageOutput() : directory_(fs::path(testing::TempDir()) / ("weir_image_" + std::to_string(::getpid()))) {
    fs::create_directory(directory_);
  }
  ~ImageOutput() override { fs::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
  }
  std::string message(const std::string& name, ErrorKind kind) const {
    try {
      const ImageFile file(*files_, path(name), false);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind);
      return error.what();
    }
    return "no error";
  }

  fs::path directory_;
  std::unique_ptr<FileSystem> files_ = make_posix_file_system();
};

Image gradient_image() {
  Image image(5, 3);
  for (std::int32_t y = 0; y < 3; ++y) {
    for (std::int32_t x = 0; x < 5; ++x) {
      image.pixels[image.index(x, y)] = {0.25F * static_cast<float>(x), 0.5F * static_cast<float>(y), 0.1F};
    }
  }
  image.pixels[4] = {100, -1, std::numeric_limits<float>::quiet_NaN()};
  return image;
}

TEST_F(ImageOutput, PngReadsBack) {
  ImageFile file(*files_, path("a.png"), false);
  EXPECT_EQ(entries(), 1U);
  EXPECT_FALSE(fs::exists(path("a.png"))) << "nothing is there before commit";
  const std::uint64_t bytes = file.commit(gradient_image(), {.exposure = 1, .soft_clip = false});
  EXPECT_EQ(entries(), 1U);
  EXPECT_EQ(fs::file_size(path("a.png")), bytes);

  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&head, path("a.png").c_str()), 0);
  EXPECT_EQ(head.width, 5U);
  EXPECT_EQ(head.height, 3U);
  EXPECT_EQ(head.format, static_cast<unsigned>(PNG_FORMAT_RGB));
  std::vector<std::uint8_t> rows(PNG_IMAGE_SIZE(head));
  ASSERT_NE(png_image_finish_read(&head, nullptr, rows.data(), 0, nullptr), 0);
  const auto pixel = [&](std::size_t x, std::size_t y) {
    return std::array<int, 3>{rows[3 * (5 * y + x)], rows[3 * (5 * y + x) + 1], rows[3 * (5 * y + x) + 2]};
  };
  // sRGB of 0, 0.1, 0.25, 0.5 and 1 by IEC 61966-2-1.
  EXPECT_EQ(pixel(0, 0), (std::array<int, 3>{0, 0, 89}));
  EXPECT_EQ(pixel(1, 1), (std::array<int, 3>{137, 188, 89}));
  EXPECT_EQ(pixel(2, 2), (std::array<int, 3>{188, 255, 89}));
  EXPECT_EQ(pixel(4, 0), (std::array<int, 3>{255, 0, 0})) << "clipped above, below and where it is no number";
}

TEST_F(ImageOutput, ExrReadsBackExactly) {
  ImageFile file(*files_, path("a.EXR"), false);
  Image image = gradient_image();
  image.pixels[4] = {100, -1, 1e-7F};
  file.commit(image, {.exposure = 7, .soft_clip = true});
  float* rgba = nullptr;
  int width = 0;
  int height = 0;
  const char* reason = nullptr;
  ASSERT_EQ(LoadEXR(&rgba, &width, &height, path("a.EXR").c_str(), &reason), TINYEXR_SUCCESS);
  const std::unique_ptr<float, decltype(&std::free)> owner(rgba, &std::free);
  ASSERT_EQ(width, 5);
  ASSERT_EQ(height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    EXPECT_EQ((Float3{rgba[4 * i], rgba[4 * i + 1], rgba[4 * i + 2]}), image.pixels[i]) << i;
  }
}

TEST_F(ImageOutput, WithoutCommitNothingIsLeft) {
  { const ImageFile file(*files_, path("a.png"), false); }
  EXPECT_EQ(entries(), 0U);
}

TEST_F(ImageOutput, CommitReplaces) {
  std::ofstream(path("a.png")) << "old";
  ImageFile file(*files_, path("a.png"), true);
  EXPECT_EQ(fs::file_size(path("a.png")), 3U) << "the old one stays until the new one is complete";
  file.commit(gradient_image(), {});
  EXPECT_GT(fs::file_size(path("a.png")), 60U);
}

TEST_F(ImageOutput, WithoutOverwrite_AnExistingFileIsRefusedAndStays) {
  ImageFile early(*files_, path("a.png"), false);
  std::ofstream(path("a.png")) << "old";
  EXPECT_EQ(message("a.png", ErrorKind::usage), path("a.png") + ": exists; choose another output or pass --overwrite");
  EXPECT_THROW(early.commit(gradient_image(), {}), Error) << "it came while the picture was made";
  EXPECT_EQ(fs::file_size(path("a.png")), 3U);
}

TEST_F(ImageOutput, LongestNameLeavesNoOtherFile) {
  EXPECT_NE(message(std::string(244, 'n') + ".png", ErrorKind::usage)
                .find(": its name has 248 bytes, and with what weir writes beside it at most 247 can be used"),
            std::string::npos);
  const std::string longest = std::string(243, 'n') + ".png";
  {
    ImageFile file(*files_, path(longest), false);
    file.commit(gradient_image(), {});
  }
  EXPECT_TRUE(fs::exists(path(longest)));
  EXPECT_EQ(entries(), 1U);
}

TEST_F(ImageOutput, WrongNamesAreUsage) {
  EXPECT_EQ(message("a.jpg", ErrorKind::usage), "-o " + path("a.jpg") + ": an image's name must end in .png or .exr");
  EXPECT_EQ(message("a", ErrorKind::usage), "-o " + path("a") + ": an image's name must end in .png or .exr");
  fs::create_directory(path("d.png"));
  EXPECT_EQ(message("d.png", ErrorKind::usage), path("d.png") + ": is a directory; name a file in it");
}

TEST_F(ImageOutput, MissingDirectoryIsIo) {
  EXPECT_EQ(message("missing/a.png", ErrorKind::io), path("missing/a.png") + ": the directory " + path("missing") +
                                                         " does not exist; make it or choose another output");
}

TEST(ToneMap, SoftClip) {
  const ToneMapping soft{};
  EXPECT_EQ(tone_map(0.5F, soft), 0.5F);
  EXPECT_EQ(tone_map(kShoulder, soft), kShoulder);
  EXPECT_NEAR(tone_map(1, soft), 0.9F, 1e-6F);
  EXPECT_EQ(tone_map(kInfinity, soft), 1.0F);
  EXPECT_EQ(tone_map(-1, soft), 0.0F);
  EXPECT_EQ(tone_map(std::numeric_limits<float>::quiet_NaN(), soft), 0.0F);
  float last = 0;
  for (float v = 0; v < 10; v += 0.01F) {
    EXPECT_GE(tone_map(v, soft), last);
    EXPECT_LE(tone_map(v, soft), 1.0F);
    last = tone_map(v, soft);
  }
}

TEST(ToneMap, ExposureAndHardClip) {
  EXPECT_EQ(tone_map(0.25F, {.exposure = 2, .soft_clip = false}), 0.5F);
  EXPECT_EQ(tone_map(0.75F, {.exposure = 2, .soft_clip = false}), 1.0F);
}

}  // namespace
}  // namespace weir::image_output_test
