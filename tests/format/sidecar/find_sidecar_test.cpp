#include "format/sidecar/find_sidecar.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temporary_directory.h"

namespace weir::find_sidecar_test {
namespace {

void make(const std::string& path) { std::ofstream(path) << '\n'; }

TEST(FindSidecar, OfALink_IsBesideTheLinkOrBesideItsFile) {
  const TemporaryDirectory scratch;
  std::filesystem::create_directory(scratch / "results");
  const std::string volume = scratch / "results/v.nvdb";
  const std::string link = scratch / "link.nvdb";
  make(volume);
  std::filesystem::create_symlink("results/v.nvdb", link);
  EXPECT_EQ(find_sidecar(volume), volume + ".json");
  EXPECT_EQ(find_sidecar(link), link + ".json") << "neither has one";

  make(volume + ".json");
  EXPECT_EQ(std::filesystem::canonical(find_sidecar(link)), std::filesystem::canonical(volume + ".json"));
  make(link + ".json");
  EXPECT_EQ(find_sidecar(link), link + ".json");
}

TEST(FindSidecar, OfALinkToNothing_IsBesideTheLink) {
  const TemporaryDirectory scratch;
  std::filesystem::create_symlink("missing.nvdb", scratch / "link.nvdb");
  EXPECT_EQ(find_sidecar(scratch / "link.nvdb"), scratch / "link.nvdb.json");
}

}  // namespace
}  // namespace weir::find_sidecar_test
