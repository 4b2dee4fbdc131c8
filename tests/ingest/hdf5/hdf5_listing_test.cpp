// What list_hdf5 says about a file.
#include <algorithm>
#include <chrono>

#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_listing_test {
namespace {

class Hdf5Listing : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }

  Scratch scratch_;
};

// A soft link to an object of the same file has no entry of its own, because the object has one.
TEST_F(Hdf5Listing, LinksThatLeadNowhere_AreListedWithTheirTarget) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["v"] = values("f4"); expect("v", f["v"][()])
    f["good"] = h5py.SoftLink("/v")
    f["lost"] = h5py.SoftLink("/gone/v")
    f["round"] = h5py.SoftLink("/round")
    f.create_group("g")["near"] = h5py.SoftLink("none")
)");
  SourceOptions options;
  options.lists_damaged = true;
  std::vector<std::string> listed;
  for (const DatasetInfo& info : list_hdf5(scratch_.path("a.h5"), options)) {
    listed.push_back(info.name + ": " + info.obstacle);
  }
  EXPECT_EQ(listed, (std::vector<std::string>{"/lost: is a soft link to /gone/v, which is not there",
                                              "/round: is a soft link to /round, which is not there",
                                              "/v: ", "/g/near: is a soft link to none, which is not there"}));
  EXPECT_EQ(list_hdf5(scratch_.path("a.h5"), {}).size(), 1U);
  expect_reads(scratch_, "a.h5", {}, "v");
}

TEST_F(Hdf5Listing, SaysShapeTypeLayoutAndObstacle) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    d = f.create_dataset("b/packed", data=values(">i2", (3,) + SHAPE), chunks=(1, 2, 3, 4), compression="gzip", shuffle=True)
    d.attrs.update({"long_name": "density of it", "units": "kg m-3", "scale_factor": 0.5, "_FillValue": np.int16(-1),
                    "spacing": [1.0, 2.0, 3.0]})
    f["b/table"] = np.zeros(4, [("a", "f4"), ("b", "i4")])
    f["plain"] = values("f4")
    f.create_dataset("filtered", (4, 4, 4), "f8", chunks=(2, 2, 2), fletcher32=True, compression="szip")
)");
  const std::vector<DatasetInfo> listed = list_hdf5(scratch_.path("a.h5"), {});
  ASSERT_EQ(listed.size(), 4U);
  EXPECT_EQ(listed[0].name, "/filtered");
  EXPECT_EQ(listed[0].layout, "chunked 2 x 2 x 2, szip, fletcher32");
  EXPECT_EQ(listed[0].obstacle, "no value was ever written to it; convert it when its values are there");

  EXPECT_EQ(listed[1].name, "/plain");
  EXPECT_EQ(listed[1].extents, (std::vector<std::int64_t>{5, 7, 9}));
  EXPECT_EQ(listed[1].type, "float32");
  EXPECT_EQ(listed[1].layout, "contiguous");
  EXPECT_EQ(listed[1].leading_axes, 0U);
  EXPECT_TRUE(listed[1].attributes.empty());
  EXPECT_EQ(listed[1].obstacle, "");

  EXPECT_EQ(listed[2].name, "/b/packed");
  EXPECT_EQ(listed[2].extents, (std::vector<std::int64_t>{3, 5, 7, 9}));
  EXPECT_EQ(listed[2].type, "big-endian int16");
  EXPECT_EQ(listed[2].layout, "chunked 1 x 2 x 3 x 4, shuffle, gzip");
  EXPECT_EQ(listed[2].leading_axes, 1U);
  using Attributes = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(listed[2].attributes, (Attributes{{"long_name", "density of it"},
                                              {"units", "kg m-3"},
                                              {"missing", "-1"},
                                              {"values", "stored * 0.5 + 0"},
                                              {"spacing x,y,z", "1,2,3"}}));

  EXPECT_EQ(listed[3].name, "/b/table");
  EXPECT_EQ(listed[3].type, "compound of 2 members");
  EXPECT_EQ(listed[3].leading_axes, 0U);
  EXPECT_EQ(listed[3].obstacle,
            "its type is compound of 2 members; a volume has integers of 8 to 64 bits or floats of 16, 32 or 64");
}

TEST_F(Hdf5Listing, ListsThousandsOfGroupsAndCyclicLinks) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w", libver="latest") as f:
    v = np.zeros((2, 2, 2), "u1")
    for i in range(3000): f["step%04d/field" % i] = v
    for i in range(3000): f["step%04d/up" % i] = f["/"]
    g = f
    for i in range(200): g = g.create_group("g")
    g["deep"] = v
)");
  const auto start = std::chrono::steady_clock::now();
  const std::vector<DatasetInfo> listed = list_hdf5(scratch_.path("a.h5"), {});
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_EQ(listed.size(), 3001U);
  EXPECT_EQ(
      std::count_if(listed.begin(), listed.end(),
                    [](const DatasetInfo& d) { return d.name.starts_with("/step") && d.name.ends_with("/field"); }),
      3000);
}

}  // namespace
}  // namespace weir::hdf5_listing_test
