#include "daemon/watch/path_filter.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temporary_directory.h"

namespace weir::path_filter_test {
namespace {

namespace fs = std::filesystem;

class PathFilterTest : public testing::Test {
 protected:
  PathFilterTest() {
    fs::create_directory(directory / "in");
    watch.directory = directory / "in";
    watch.recursive = true;
  }
  bool accepts(const std::string& path) const { return PathFilter(watch).accepts_file(path); }
  bool enters(const std::string& path) const { return PathFilter(watch).enters_directory(path); }

  TemporaryDirectory directory;
  WatchConfig watch;
};

TEST_F(PathFilterTest, NoIncludePattern_TakesNamesOfKnownFormats) {
  for (const char* name :
       {"a_64x64x64_uint8.raw", "sub/b_1x2x3_float32be.raw", "a.h5", "a.HDF5", "a.nc", "a.nii.gz", "a.nhdr", "a.mha",
        "a.vti", "a.vtk", "a.vdb", "a.zarr.zip", "a.ozx", "name with\nnewline.nc", "\xff.h5"}) {
    EXPECT_TRUE(accepts(name)) << name;
  }
  for (const char* name : {"a.raw", "a.txt", "a.log", "a.nvdb", "a.nvdb.png", "a.nvdb.json", "a.nvdb.partial",
                           "a.h5.partial", ".a.h5", "h5", "a.h5.gz", ""}) {
    EXPECT_FALSE(accepts(name)) << name;
  }
}

// The file's job reports what is missing; without a job, nothing would.
TEST_F(PathFilterTest, DimsOrTypeInTheWatch_TakesAnyRawName) {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--dims=4,4,4"}, {"--type=uint8"}, {"--dims=4,4,4", "--type=uint8"}}) {
    watch.convert_options = options;
    EXPECT_TRUE(accepts("a.raw")) << options[0];
    EXPECT_TRUE(accepts("sub/a.RAW")) << options[0];
    EXPECT_FALSE(accepts("a.bin")) << options[0];
    EXPECT_FALSE(accepts("a.nvdb")) << options[0];
  }
  watch.convert_options = {"--rate=8"};
  EXPECT_FALSE(accepts("a.raw"));
}

TEST_F(PathFilterTest, PatternsWithASlashMatchPathsOthersMatchNames) {
  watch.include = {"rho_*.bin", "run*/out/*.dat", ".hidden.bin"};
  watch.exclude = {"*_tmp.bin", "old"};
  EXPECT_TRUE(accepts("rho_1.bin"));
  EXPECT_TRUE(accepts("deep/down/rho_1.bin"));
  EXPECT_TRUE(accepts("run7/out/a.dat"));
  EXPECT_TRUE(accepts("x/.hidden.bin"));
  EXPECT_FALSE(accepts("a.dat"));
  EXPECT_FALSE(accepts("x/run7/out/a.dat"));
  EXPECT_FALSE(accepts("rho_1_tmp.bin"));
  EXPECT_FALSE(accepts("a.h5"));
  EXPECT_FALSE(enters("x/old"));
  EXPECT_TRUE(enters("x/older"));
}

TEST_F(PathFilterTest, PlotfilesGoByTheNamesOfTheirDirectories) {
  EXPECT_TRUE(accepts("plt00042/Header"));
  EXPECT_TRUE(accepts("run7/plt00042/Header"));
  EXPECT_FALSE(accepts("Header"));
  EXPECT_FALSE(accepts("plt00042/Level_0/Cell_H"));
  EXPECT_FALSE(accepts("plt00042.temp/Header"));
  EXPECT_FALSE(accepts("plt00042.old.1234567/Header"));
  watch.include = {"plt*", "run*/x*"};
  EXPECT_TRUE(accepts("plt00042/Header"));
  EXPECT_TRUE(accepts("deep/plt00042/Header"));
  EXPECT_TRUE(accepts("run7/x1/Header"));
  EXPECT_FALSE(accepts("chk00042/Header"));
  watch.exclude = {"*1"};
  EXPECT_FALSE(accepts("run7/x1/Header"));
  watch.recursive = false;
  EXPECT_FALSE(accepts("plt00042/Header"));
}

TEST_F(PathFilterTest, HiddenDirectoriesAreNotEnteredAndNoneWithoutRecursion) {
  EXPECT_TRUE(enters("a"));
  EXPECT_FALSE(enters(".snapshot"));
  EXPECT_FALSE(enters("a/.git"));
  watch.recursive = false;
  EXPECT_FALSE(enters("a"));
  EXPECT_TRUE(accepts("a.h5"));
  EXPECT_FALSE(accepts("a/b.h5"));
}

TEST_F(PathFilterTest, FilesOfWeirItselfAreNeverSources) {
  watch.include = {"*", ".*"};
  watch.excluded_paths = {directory / "in/nvdb", directory / "in/weir.db"};
  EXPECT_FALSE(accepts("a.nvdb.json"));
  EXPECT_FALSE(accepts("a.nvdb.json.previous"));
  EXPECT_FALSE(accepts(".a.nvdb.png.12.partial"));
  EXPECT_FALSE(accepts("weir.db"));
  EXPECT_FALSE(accepts("nvdb/a.h5"));
  EXPECT_FALSE(enters("nvdb"));
  EXPECT_TRUE(enters("nvdb2"));
  EXPECT_TRUE(accepts("weir.db2"));
}

TEST_F(PathFilterTest, NumberedFilesOfWeirItselfAreNeverSources) {
  watch.include = {"*"};
  watch.excluded_numbers = {
      {directory / "in/weir.", ".log"}, {directory / "in/sub/weir.db.corrupt-", "", true}, {directory / "in/run.", ""}};
  for (const char* name :
       {"weir.1.log", "weir.12.log", "sub/weir.db.corrupt-1", "sub/weir.db.corrupt-2-wal", "run.1"}) {
    EXPECT_FALSE(accepts(name)) << name;
  }
  for (const char* name : {"weir.log", "weir.x.log", "weir.1.log.raw", "sub/weir.1.log", "weir.db.corrupt-1",
                           "sub/weir.db.corrupt-", "run.0001_32x32x32_float32.raw"}) {
    EXPECT_TRUE(accepts(name)) << name;
  }
}

TEST_F(PathFilterTest, ZarrHierarchiesGoByTheNamesOfTheirDirectories) {
  for (const char* head : {"zarr.json", ".zgroup", ".zarray"}) {
    EXPECT_TRUE(accepts(std::string("run.zarr/") + head)) << head;
    EXPECT_TRUE(accepts(std::string("a/run.ome.zarr/") + head)) << head;
    EXPECT_FALSE(accepts(std::string("run.zarr/rho/") + head)) << head;
    EXPECT_FALSE(accepts(std::string("run/") + head)) << head;
  }
  EXPECT_TRUE(enters("run.zarr"));
  EXPECT_FALSE(enters("run.zarr/c"));
  watch.include = {"step_*"};
  EXPECT_TRUE(accepts("step_7.zarr/zarr.json"));
  EXPECT_FALSE(accepts("run.zarr/zarr.json"));
  EXPECT_FALSE(accepts("run.zarr/step_7"));  // a chunk
  watch.exclude = {"*_tmp.zarr"};
  EXPECT_FALSE(accepts("step_7_tmp.zarr/.zgroup"));
  EXPECT_FALSE(enters("step_7_tmp.zarr"));
  watch.recursive = false;
  EXPECT_FALSE(accepts("step_7.zarr/zarr.json"));
}

TEST_F(PathFilterTest, ExcludedPathsAreComparedWithLinksResolved) {
  fs::create_directory_symlink(directory / "in", directory / "link");
  watch.directory = directory / "link";
  watch.excluded_paths = {directory / "in/nvdb"};  // a path that does not exist is allowed
  EXPECT_FALSE(accepts("nvdb/a.h5"));
  EXPECT_TRUE(accepts("a.h5"));
}

TEST_F(PathFilterTest, MarkersNameTheirSources) {
  watch.complete = Completion::marker;
  watch.marker = ".ok";
  watch.include = {"*"};
  const PathFilter filter(watch);
  EXPECT_FALSE(filter.accepts_file("a.bin.ok"));
  EXPECT_EQ(filter.marked_source("sub/a.bin.ok"), "sub/a.bin");
  EXPECT_EQ(filter.marked_source("a.bin"), std::nullopt);
  EXPECT_EQ(filter.marked_source("a.partial.ok"), std::nullopt);
  EXPECT_EQ(filter.marked_source(".ok"), std::nullopt);
  watch.complete = Completion::automatic;
  EXPECT_EQ(PathFilter(watch).marked_source("a.bin.ok"), std::nullopt);
}

TEST_F(PathFilterTest, LinksToTargetsOutsideOrExcludedAreRefused) {
  const std::string in = fs::canonical(directory / "in");
  const std::string out = fs::canonical(directory.path());
  fs::create_directory(directory / "in2");  // a name with the same beginning
  for (const char* name : {"in/a.h5", "in2/b.h5"}) std::ofstream(directory / name) << "1";
  fs::create_directory(directory / "in/nvdb");
  std::ofstream(directory / "in/nvdb/c.h5") << "1";
  fs::create_symlink("a.h5", directory / "in/inside.h5");
  fs::create_symlink(directory / "in2/b.h5", directory / "in/outside.h5");
  fs::create_symlink("outside.h5", directory / "in/chain.h5");
  fs::create_symlink("nvdb/c.h5", directory / "in/own.h5");
  watch.excluded_paths = {directory / "in/nvdb"};
  const PathFilter filter(watch);
  EXPECT_EQ(filter.link_refusal("inside.h5"), "");
  const std::string refusal =
      "a symbolic link to " + out + "/in2/b.h5, outside the watched directory; watch that directory too";
  EXPECT_EQ(filter.link_refusal("outside.h5"), refusal);
  EXPECT_EQ(filter.link_refusal("chain.h5"), refusal);
  EXPECT_EQ(filter.link_refusal("own.h5"), "a symbolic link to " + in + "/nvdb/c.h5, which is weir's own");
}

}  // namespace
}  // namespace weir::path_filter_test
