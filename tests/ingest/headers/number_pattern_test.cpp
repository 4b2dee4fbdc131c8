// Tests patterns with a running number, and the files that they name.
#include "ingest/headers/number_pattern.h"

#include <sys/stat.h>

#include <filesystem>

#include "tests/ingest/support/scratch.h"

namespace weir::number_pattern_test {
namespace {

TEST(NumberPattern, NameAndMatchAreInverse) {
  const auto padded = NumberPattern::parse("plane_%05d.raw");
  ASSERT_TRUE(padded);
  EXPECT_EQ(padded->name(42), "plane_00042.raw");
  EXPECT_EQ(padded->name(1234567), "plane_1234567.raw");
  EXPECT_EQ(padded->match("plane_00042.raw"), 42);
  EXPECT_EQ(padded->match("plane_1234567.raw"), 1234567);
  for (const char* other : {"plane_42.raw", "plane_000042.raw", "plane_00042.raw.gz", "plane_.raw", "plane_+0042.raw",
                            "plane_-0042.raw", "plan_00042.raw", "plane_99999999999999999999.raw"}) {
    EXPECT_FALSE(padded->match(other)) << other;
  }
  const auto plain = NumberPattern::parse("/data/%d/meshes/rho");
  EXPECT_EQ(plain->match("/data/0/meshes/rho"), 0);
  EXPECT_EQ(plain->match("/data/100/meshes/rho"), 100);
  EXPECT_FALSE(plain->match("/data/007/meshes/rho"));
  EXPECT_EQ(NumberPattern::parse("t%3d")->match("t  7"), 7);
}

TEST(NumberPattern, NeedsOnePlaceForANumber) {
  for (const char* text : {"plane.raw", "100%.raw", "%s.raw", "a%db%d", "%0999d", "%"}) {
    EXPECT_FALSE(NumberPattern::parse(text)) << text;
  }
  EXPECT_EQ(NumberPattern::parse("50%_%d")->name(3), "50%_3");
}

TEST(NumberPattern, Stem) {
  EXPECT_EQ(NumberPattern::parse("plane_%05d.raw")->stem(), "plane");
  EXPECT_EQ(NumberPattern::parse("a_%d_64x64x1_uint8.raw")->stem(), "a_64x64x1_uint8");
  EXPECT_EQ(NumberPattern::parse("%d.raw")->stem(), "");
}

TEST(NumberedFiles, ByRisingNumber) {
  const Scratch scratch;
  for (const char* name : {"p_10.raw", "p_9.raw", "p_x.raw", "q_1.raw"}) scratch.write(name, {});
  const auto files = numbered_files(scratch.path("p_%d.raw"));
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].number, 9);
  EXPECT_EQ(files[0].path, scratch.path("p_9.raw"));
  EXPECT_EQ(files[1].number, 10);

  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { numbered_files(scratch.path("r_%d.raw")); }),
            scratch.path("r_%d.raw") + ": no file's name matches; check the pattern");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { numbered_files(scratch.path("none/r_%d.raw")); }),
            scratch.path("none") + ": cannot list: No such file or directory; check the pattern");
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { numbered_files("a.raw"); }),
            "a.raw: no pattern: the file's name needs one %d or %05d where its number is");
}

TEST(NumberedFiles, WhatCannotBeRead_IsListedToo) {
  const Scratch scratch;
  scratch.write("p_1.raw", {});
  std::filesystem::create_symlink(scratch.path("none"), scratch.path("p_2.raw"));
  std::filesystem::create_directory(scratch.path("p_3.raw"));
  ASSERT_EQ(::mkfifo(scratch.path("p_4.raw").c_str(), 0600), 0);
  const auto files = numbered_files(scratch.path("p_%d.raw"));
  ASSERT_EQ(files.size(), 4U);
  for (std::size_t i = 0; i < files.size(); ++i) {
    EXPECT_EQ(files[i].number, static_cast<std::int64_t>(i) + 1);
    EXPECT_EQ(files[i].path, scratch.path("p_" + std::to_string(i + 1) + ".raw"));
  }
}

}  // namespace
}  // namespace weir::number_pattern_test
