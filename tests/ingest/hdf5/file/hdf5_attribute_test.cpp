// Attributes that the library cannot read: an error, and never values or places as if they were not there.
#include "ingest/hdf5/file/hdf5_attribute.h"

#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"

namespace weir::hdf5_attribute_test {
namespace {

class Hdf5Attribute : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }
  /// What opening, and listing, say of the file.
  std::string refused(const std::string& file) {
    std::string opened = message_of_error(ErrorKind::input, [&] { open_source(scratch_.path(file), {}); });
    EXPECT_EQ(message_of_error(ErrorKind::input, [&] { list_hdf5(scratch_.path(file), {}); }), opened);
    return opened;
  }

  const std::string remedy_ =
      "; they are damaged, or of a later version of HDF5: copy the file again, or write it anew";
  Scratch scratch_;
};

TEST_F(Hdf5Attribute, DamagedHeadOfAnAttribute_IsAnError) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["q"] = values("i2")
    f["q"].attrs.update({"scale_factor": 0.5, "add_offset": 100.0, "_FillValue": np.int16(5)})
data = bytearray(open("a.h5", "rb").read())
data[data.find(b"scale_factor") - 6] ^= 0xff  # the length of the name
open("a.h5", "wb").write(data)
)");
  const std::string message = refused("a.h5");
  EXPECT_TRUE(message.starts_with(scratch_.path("a.h5") + ": /q: its attributes cannot be read, looking for "))
      << message;
  EXPECT_NE(message.find(": attribute name has different length than stored length" + remedy_), std::string::npos)
      << message;
}

TEST_F(Hdf5Attribute, LostTextsOfAnAttribute_AreAnError) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["q"] = values("i2")
    f["q"].attrs["_Unsigned"] = "true"
data = open("a.h5", "rb").read()
assert data.count(b"GCOL") == 1  # the heap that the text lies in
open("a.h5", "wb").write(data.replace(b"GCOL", b"lost"))
)");
  EXPECT_EQ(refused("a.h5"), scratch_.path("a.h5") +
                                 ": /q: its attributes cannot be read, looking for _Unsigned: bad global heap "
                                 "collection signature" +
                                 remedy_);
}

TEST_F(Hdf5Attribute, LostScalesOfAnAxis_AreAnError) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["q"] = values("f4")
    f["x"] = np.arange(9) * 0.25
    f["x"].make_scale()
    f["q"].dims[2].attach_scale(f["x"])
data = open("a.h5", "rb").read()
assert data.count(b"GCOL") == 1
open("a.h5", "wb").write(data.replace(b"GCOL", b"lost"))
)");
  EXPECT_EQ(refused("a.h5"), scratch_.path("a.h5") +
                                 ": /q: its attributes cannot be read, looking for DIMENSION_LIST: bad global "
                                 "heap collection signature" +
                                 remedy_);
}

TEST_F(Hdf5Attribute, MoreMissingValuesThanAreRead_AreAnError) {
  write_by_h5py(scratch_, R"(
for name, count in [("most.h5", 4096), ("more.h5", 5000)]:
    with h5py.File(name, "w", libver="latest") as f:
        f["q"] = values("i2")
        f["q"].attrs["missing_value"] = np.arange(count, dtype="i2")
)");
  EXPECT_EQ(open_source(scratch_.path("most.h5"), {})->info().mapping.missing.size(), kMaxAttributeValues);
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(scratch_.path("more.h5"), {}); }),
            scratch_.path("more.h5") +
                ": /q: its attribute missing_value has 5000 values, and at most 4096 are read, so which voxels hold no "
                "data is unknown; shorten it");
}

TEST_F(Hdf5Attribute, MissingValuesThatAreNoNumbers_AreAnError) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name, value in [("numbers", ["1", "-999"]), ("one", "abc"), ("some", ["1", "x"]), ("mixed", np.array([(1, 2.)], "i4,f4"))]:
        f[name] = values("f4")
        f[name].attrs["_FillValue"] = value
)");
  SourceOptions options;
  const auto refusal = [&](const std::string& dataset) {
    options.dataset = dataset;
    return message_of_error(ErrorKind::input, [&] { open_source(scratch_.path("a.h5"), options); });
  };
  const std::string begin = ": its attribute _FillValue is ";
  const std::string end = ", so which voxels hold no data is unknown; correct or remove it";
  EXPECT_EQ(refusal("one"), scratch_.path("a.h5") + ": /one" + begin + "'abc' and not a number" + end);
  EXPECT_EQ(refusal("some"), scratch_.path("a.h5") + ": /some" + begin + "2 values ('1', 'x') and not numbers" + end);
  EXPECT_EQ(refusal("mixed"),
            scratch_.path("a.h5") + ": /mixed" + begin + "of type compound of 2 members and not a number" + end);
  options.dataset = "numbers";
  EXPECT_EQ(open_source(scratch_.path("a.h5"), options)->info().mapping.missing.size(), 2U);
}

// Of an attribute that gives a place or a name, as many values as that are of another meaning.
TEST_F(Hdf5Attribute, LongAttributeOfAnotherMeaning_IsPassedOver) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w", libver="latest") as f:
    f["q"] = values("f4")
    f["q"].attrs["spacing"] = np.ones(5000)
    f["q"].attrs["description"] = np.bytes_(b"x" * (2 << 20))
)");
  const SourceInfo info = open_source(scratch_.path("a.h5"), {})->info();
  EXPECT_EQ(info.spacing, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(info.details.long_name, "");
}

}  // namespace
}  // namespace weir::hdf5_attribute_test
