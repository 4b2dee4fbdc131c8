#include "daemon/config/watch_conflicts.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "format/base/text.h"
#include "tests/support/temporary_directory.h"

namespace weir::watch_conflicts_test {
namespace {

WatchConfig watch(const std::string& directory, const std::string& output) {
  WatchConfig config;
  config.label = config.directory = directory;
  config.output = output;
  return config;
}

/// Returns the conflict as "WATCH KEY: MESSAGE"; empty if there is none.
std::string conflict(const std::vector<WatchConfig>& watches) {
  const auto found = find_conflict(watches);
  return found ? cat(found->watch, ' ', found->key, ": ", found->message) : "";
}

TEST(WatchConflicts, SeparateDirectories_DoNotConflict) {
  EXPECT_EQ(conflict({watch("/in", "/in/nvdb"), watch("/in2", "/in2/nvdb"), watch("/in3", "/out")}), "");
  EXPECT_EQ(conflict({watch("/in", "/innvdb"), watch("/innvdb2", "/x")}), "") << "a common beginning is no directory";
}

TEST(WatchConflicts, SameLabelTwice_IsAConflict) {
  const std::string message =
      R"(1 label: there is a watch of the label "/in" already; give this one a label of its own)";
  EXPECT_EQ(conflict({watch("/in", "/a"), watch("/in", "/b")}), message);
  WatchConfig labelled = watch("/in", "/b");
  labelled.label = "coarse";
  EXPECT_EQ(conflict({watch("/in", "/a"), labelled}), "");
}

TEST(WatchConflicts, SourcesInsideAnOutput_AreAConflict) {
  EXPECT_EQ(conflict({watch("/in", "/in")}),
            "0 output: /in is watched and lies in the output /in, so that results would be converted again; separate "
            "them, /in/nvdb is a good output for instance");
  EXPECT_EQ(conflict({watch("/run/in", "/run")}),
            "0 output: /run/in is watched and lies in the output /run, so that results would be converted again; "
            "separate them, /run/in/nvdb is a good output for instance");
  EXPECT_EQ(conflict({watch("/in", "/out"), watch("/out/deep", "/b")}),
            "1 directory: /out/deep is watched and lies in the output /out of the watch \"/in\", so that results "
            "would be converted again; separate them, /out/deep/nvdb is a good output for instance");
}

TEST(WatchConflicts, SameOutputNames_AreAConflict) {
  WatchConfig second = watch("/in2", "/out");
  EXPECT_EQ(conflict({watch("/in", "/out"), second}),
            "1 output: the watch \"/in\" writes the same names, {stem}.nvdb in /out; give this one another output or "
            "name");
  second.name = "{stem}.nvdb";
  EXPECT_NE(conflict({watch("/in", "/out"), second}), "");
  second.name = "{stem}_2.nvdb";
  EXPECT_EQ(conflict({watch("/in", "/out"), second}), "");
}

TEST(WatchConflicts, NamesThatAreEqualWithoutADataset_AreAConflict) {
  WatchConfig second = watch("/in2", "/out");
  second.name = "{stem}{dataset}.nvdb";
  EXPECT_EQ(conflict({watch("/in", "/out"), second}),
            "1 output: the watch \"/in\" writes the same names, {stem}.nvdb in /out; give this one another output or "
            "name");
  second.name = "{step}{stem}{dataset}.nvdb";
  EXPECT_NE(conflict({watch("/in", "/out"), second}), "");
  EXPECT_NE(conflict({second, watch("/in", "/out")}), "");
  second.name = "{stem}_{dataset}.nvdb";
  EXPECT_EQ(conflict({watch("/in", "/out"), second}), "") << "a_.nvdb and a.nvdb";
  WatchConfig choosing = watch("/in", "/out");
  choosing.convert_options = {"--dataset=rho"};
  EXPECT_EQ(conflict({choosing, second}),
            "1 output: the watch \"/in\" writes the same names, {stem}_{dataset}.nvdb in /out; give this one another "
            "output or name")
      << "that is the default's name in a file of several datasets";
}

TEST(WatchConflicts, SubdirectoryConvertedTwiceToOneName_IsAConflict) {
  WatchConfig outer = watch("/in", "/out");
  WatchConfig inner = watch("/in/sub/deep", "/out/sub/deep");
  EXPECT_EQ(conflict({outer, inner}), "") << "only one of them enters the sub-directory";
  outer.recursive = true;
  const std::string message =
      " writes the same names, {stem}.nvdb in /out/sub/deep; give this one another output or name, or exclude sub/deep "
      "from the watch \"/in\"";
  EXPECT_EQ(conflict({outer, inner}), "1 output: the watch \"/in\"" + message);
  EXPECT_EQ(conflict({inner, outer}), "1 output: the watch \"/in/sub/deep\"" + message);
  inner.output = "/out/deep";
  EXPECT_EQ(conflict({outer, inner}), "") << "another place below the output";
  inner.output = "/out/sub/deep";
  inner.name = "{stem}_2.nvdb";
  EXPECT_EQ(conflict({outer, inner}), "");
}

TEST(WatchConflicts, SubdirectoryExcludedFromTheOuterWatch_DoesNotConflict) {
  WatchConfig outer = watch("/in", "/out");
  outer.recursive = true;
  const WatchConfig inner = watch("/in/sub/deep", "/out/sub/deep");
  for (const char* pattern : {"sub", "deep", "sub/deep", "sub/*", "sub/deep/*", "**/deep"}) {
    outer.exclude = {pattern};
    EXPECT_EQ(conflict({outer, inner}), "") << pattern;
  }
  for (const char* pattern : {"su", "sub/deep/*.raw", "sub/deep/[!r]*", "*.raw", "deep/*"}) {
    outer.exclude = {pattern};
    EXPECT_NE(conflict({outer, inner}), "") << pattern;
  }
}

TEST(WatchConflicts, PatternsThatKeepSubdirectoriesApart_MakeNoConflict) {
  WatchConfig outer = watch("/in", "/out");
  outer.recursive = true;
  WatchConfig inner = watch("/in/run2", "/out/run2");
  outer.include = {"run1/*.raw"};
  EXPECT_EQ(conflict({outer, inner}), "");
  outer.include = {"run1/*.raw", "run?/*.h5"};
  EXPECT_NE(conflict({outer, inner}), "");
  outer.include.clear();
  outer.exclude = {"run2/*.raw"};
  EXPECT_NE(conflict({outer, inner}), "");
  inner.include = {"*.raw"};
  EXPECT_EQ(conflict({outer, inner}), "");
  inner.recursive = true;
  EXPECT_NE(conflict({outer, inner}), "") << "run2/a/b.raw";
  outer.exclude = {"run2/**/*.raw"};
  EXPECT_EQ(conflict({outer, inner}), "");
}

TEST(WatchConflicts, DeletingSourcesOfAnotherWatch_IsAConflict) {
  WatchConfig outer = watch("/in", "/a");
  WatchConfig inner = watch("/in/deep", "/b");
  inner.source = AfterDone::delete_after_verify;
  EXPECT_EQ(conflict({outer, inner}), "");
  outer.recursive = true;
  EXPECT_EQ(conflict({outer, inner}),
            "1 source: sources would be deleted that the watch \"/in\" converts too; keep them, or watch different "
            "directories");
  EXPECT_EQ(conflict({inner, outer}),
            "0 source: sources would be deleted that the watch \"/in\" converts too; keep them, or watch different "
            "directories");
}

TEST(WatchConflicts, LinksAreFollowed) {
  const TemporaryDirectory directory;
  std::filesystem::create_directory(directory / "real");
  std::filesystem::create_directory_symlink(directory / "real", directory / "link");
  EXPECT_TRUE(is_within(directory / "link/missing/file", directory / "real"));
  EXPECT_TRUE(is_within(directory / "real", directory / "link"));
  EXPECT_FALSE(is_within(directory / "real", directory / "real/nvdb"));
  EXPECT_EQ(find_conflict(std::vector{watch(directory / "real", directory / "link")})->key, "output");
}

}  // namespace
}  // namespace weir::watch_conflicts_test
