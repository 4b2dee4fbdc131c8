// Tests datasets with their values in external files, and where such files are searched.
#include "ingest/hdf5/storage/external_files.h"

#include <cstdlib>
#include <filesystem>

#include "ingest/hdf5/file/side_files.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::external_files_test {
namespace {

TEST(ExternalFiles, AreReadAndMissingOnesAreAnError) {
  if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  const Scratch scratch;
  write_by_h5py(scratch, R"(
v = values("<f4"); expect("v", v); w = values(">i2", (2,) + SHAPE); expect("w", w[1])
with h5py.File("a.h5", "w") as f:
    f.create_dataset("one", data=v, external=[("one.raw", 13, v.nbytes)])
    f.create_dataset("endless", data=v, external="endless.raw")
    f.create_dataset("three", data=w, external=[("p0.raw", 0, 101), ("p1.raw", 7, 500), ("p2.raw", 0, h5py.h5f.UNLIMITED)])
)");
  expect_reads(scratch, "a.h5", dataset_options("one"), "v");
  expect_reads(scratch, "a.h5", dataset_options("endless"), "v");
  expect_reads(scratch, "a.h5", dataset_options("three", {1}), "w");

  const std::string where = scratch.path("a.h5") + ": /three: ";
  const auto refused = [&](const char* name) {
    return message_of_error(ErrorKind::input, [&] { open_source(scratch.path("a.h5"), dataset_options(name, {0})); });
  };
  std::filesystem::resize_file(scratch.path("p2.raw"), 658);
  EXPECT_EQ(refused("three"),
            where + "needs 659 bytes at 0 of " + scratch.path("p2.raw") + ", and that has 658; it is cut short");
  std::filesystem::remove(scratch.path("p1.raw"));
  EXPECT_EQ(refused("three"), where + "its values lie in the file p1.raw, which is not there; put it beside " +
                                  scratch.path("a.h5") + " or set HDF5_EXTFILE_PREFIX");
}

TEST(SideFiles, AreSearchedInPrefixParentAndWorkingDirectory) {
  ASSERT_EQ(::setenv("WEIR_TEST_PREFIX", "/pre", 1), 0);
  const auto places = [](const char* name, const char* parent) {
    return side_file_places(name, parent, "WEIR_TEST_PREFIX");
  };
  using Places = std::vector<std::string>;
  EXPECT_EQ(places("/abs/x", "/data/a.h5"), Places{"/abs/x"});
  EXPECT_EQ(places("x", "/data/a.h5"), (Places{"/pre/x", "/data/x", "x"}));
  EXPECT_EQ(places("x", "a.h5"), (Places{"/pre/x", "x"}));
  ASSERT_EQ(::setenv("WEIR_TEST_PREFIX", "${ORIGIN}/sub", 1), 0);
  EXPECT_EQ(places("x", "/data/a.h5"), (Places{"/data/sub/x", "/data/x", "x"}));
  EXPECT_EQ(places("x", "a.h5"), (Places{"./sub/x", "x"}));
  ASSERT_EQ(::unsetenv("WEIR_TEST_PREFIX"), 0);
  EXPECT_EQ(places("d/x", "/data/a.h5"), (Places{"/data/d/x", "d/x"}));
}

}  // namespace
}  // namespace weir::external_files_test
