// Tests the limit on nested groups.
#include "ingest/hdf5/file/hdf5_walk.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "format/base/error.h"
#include "ingest/hdf5/file/hdf5_lock.h"
#include "ingest/hdf5/hdf5_source.h"
#include "tests/support/temporary_directory.h"

namespace weir::hdf5_walk_test {
namespace {

// Writes a dataset of 2^3 floats within `depth` nested groups. Returns the name of the dataset.
std::string write_nested(const std::string& path, int depth) {
  const Hdf5Lock lock;
  const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  const Hdf5Handle names(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(names.get(), 1);
  const std::array<hsize_t, 3> extent{2, 2, 2};
  const Hdf5Handle space(H5Screate_simple(3, extent.data(), nullptr));
  std::string name;
  for (int i = 0; i < depth; ++i) name += "/g";
  name += "/v";
  const Hdf5Handle dataset(
      H5Dcreate2(file.get(), name.c_str(), H5T_NATIVE_FLOAT, space.get(), names.get(), H5P_DEFAULT, H5P_DEFAULT));
  const std::array<float, 8> values{1, 2, 3, 4, 5, 6, 7, 8};
  H5Dwrite(dataset.get(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  return name;
}

TEST(Hdf5Walk, GroupsAsDeepAsTheLimit_AreListed) {
  const TemporaryDirectory directory;
  const std::string name = write_nested(directory / "a.h5", kMaxGroupDepth);
  const auto listed = list_hdf5(directory / "a.h5", {});
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed[0].name, name);
}

TEST(Hdf5Walk, DeeperGroups_AreRefusedAndTheDatasetCanBeNamed) {
  const TemporaryDirectory directory;
  const std::string path = directory / "a.h5";
  SourceOptions options;
  options.dataset = write_nested(path, kMaxGroupDepth + 1);
  try {
    open_hdf5(path, {});
    ADD_FAILURE() << "was opened";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(std::string(error.what()),
              path +
                  ": groups are nested more than 256 deep in "
                  "'/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g/g...'; name a dataset with --dataset");
  }
  EXPECT_EQ(open_hdf5(path, options)->info().extent, (Index3{2, 2, 2}));
}

}  // namespace
}  // namespace weir::hdf5_walk_test
