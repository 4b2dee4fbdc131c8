#include "tools/report/volume_title.h"

#include <gtest/gtest.h>

namespace weir::volume_title_test {
namespace {

Sidecar::Source source(const std::string& dataset, std::vector<std::int64_t> index, const std::string& component) {
  Sidecar::Source s;
  s.path = "some/where/run.h5";
  s.dataset = dataset;
  s.index = std::move(index);
  s.component = component;
  return s;
}

TEST(VolumeTitle, NamesTheFileAndWhatWasChosenOfIt) {
  EXPECT_EQ(volume_title(source("/qc", {2, 0}, "")), "run.h5 /qc at 2,0");
  EXPECT_EQ(volume_title(source("/v", {}, "0")), "run.h5 /v, component 0");
  EXPECT_EQ(volume_title(source("/v", {3}, "magnitude")), "run.h5 /v at 3, magnitude");
  EXPECT_EQ(volume_title(source("", {}, "")), "run.h5");
  EXPECT_EQ(volume_title(source("", {}, "0")), "run.h5 component 0") << "an array that is the root of its store";
  EXPECT_EQ(volume_title(source("/a\nb", {}, "")), "run.h5 /a?b");
}

}  // namespace
}  // namespace weir::volume_title_test
