// Tests the names of filters, and the remedies for filters without a plugin.
#include "ingest/hdf5/filters/filter_names.h"

#include <gtest/gtest.h>

namespace weir::filter_names_test {
namespace {

TEST(FilterNames, RegisteredOnesHaveTheirName) {
  EXPECT_EQ(filter_name(H5Z_FILTER_DEFLATE, "deflate"), "gzip");
  EXPECT_EQ(filter_name(32015, ""), "zstd");
  EXPECT_EQ(filter_name(32004, "HDF5 lz4 filter; see http://www.hdfgroup.org"), "lz4");
  EXPECT_EQ(filter_name(65000, "ours"), "ours");
  EXPECT_EQ(filter_name(65000, ""), "filter 65000");
}

TEST(FilterNames, RemediesNameThePackageWhereThereIsOne) {
  EXPECT_EQ(filter_remedy(32004),
            "install the package hdf5-filter-plugin, or set HDF5_PLUGIN_PATH to the directory that has it");
  EXPECT_EQ(
      filter_remedy(32001),
      "install the package hdf5-filter-plugin-blosc-serial, or set HDF5_PLUGIN_PATH to the directory that has it");
  EXPECT_EQ(filter_remedy(32013),
            "install the package hdf5-filter-plugin-zfp-serial, or set HDF5_PLUGIN_PATH to the directory that has it");
  EXPECT_EQ(filter_remedy(32015), "set HDF5_PLUGIN_PATH to the directory that has it");
  EXPECT_EQ(filter_remedy(65000), "set HDF5_PLUGIN_PATH to the directory that has it");
}

}  // namespace
}  // namespace weir::filter_names_test
