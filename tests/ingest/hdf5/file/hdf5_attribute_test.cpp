// Attributes that the library cannot read are an error. weir never treats them as absent when it maps or places values.
#include "ingest/hdf5/file/hdf5_attribute.h"

#include "format/base/text.h"
#include "format/process/process_memory.h"
#include "ingest/hdf5/hdf5_source.h"
#include "tests/ingest/hdf5/support/h5py_file.h"
#include "tests/support/child_answer.h"

namespace weir::hdf5_attribute_test {
namespace {

class Hdf5Attribute : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!python_has("h5py, numpy")) GTEST_SKIP() << "python3 with h5py is missing";
  }
  /// Returns the message with which open_source() refuses the file. Checks that list_hdf5() gives the same message.
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

// A `spacing` of 5000 numbers is no spacing, and a `description` of 2 MiB is no name: weir ignores both attributes.
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

TEST_F(Hdf5Attribute, TextsOfMoreThanAMebibyte_AreReadAsNone) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    for name, text in [("most", "x" * (1 << 20)), ("more", "x" * ((1 << 20) + 1)), ("several", ["x" * (1 << 19), "y" * (1 << 19), "z"])]:
        f[name] = values("f4"); f[name].attrs["long_name"] = text
    f["missing"] = values("f4"); f["missing"].attrs["missing_value"] = "1" * (2 << 20)
)");
  const auto long_name = [&](const char* dataset) {
    return open_source(scratch_.path("a.h5"), dataset_options(dataset))->info().details.long_name;
  };
  EXPECT_EQ(long_name("most"), std::string(std::size_t{1} << 20U, 'x'));
  EXPECT_EQ(long_name("more"), "");
  EXPECT_EQ(long_name("several"), "");
  EXPECT_EQ(
      message_of_error(ErrorKind::input, [&] { open_source(scratch_.path("a.h5"), dataset_options("missing")); }),
      scratch_.path("a.h5") +
          ": /missing: its attribute missing_value is of type text of any length and not a number, so which voxels "
          "hold no data is unknown; correct or remove it");
}

// To read a long text, the library takes five times its bytes.
TEST_F(Hdf5Attribute, MemoryOfLongTexts_IsNotTaken) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w") as f:
    f["q"] = values("f4")
    f["q"].attrs["description"] = "x" * (100 << 20)
)");
  EXPECT_EQ(answer_of_child([&] {
              const std::string name = open_source(scratch_.path("a.h5"), {})->info().details.long_name;
              const std::uint64_t peak = peak_resident_bytes();
              return peak < (std::uint64_t{100} << 20U) ? name : cat(peak, " bytes");
            }),
            "");
}

// NAME tells whether a dataset is a NetCDF dimension without coordinates. weir looks for NAME before other attributes.
TEST_F(Hdf5Attribute, MemoryOfALongName_IsNotTaken) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w", libver="latest") as f:
    f["q"] = values("f4")
    f["q"].attrs["NAME"] = np.bytes_(b"x" * (200 << 20))
)");
  EXPECT_EQ(answer_of_child([&] {
              SourceOptions listing;
              listing.lists_damaged = true;
              const std::string obstacle = list_hdf5(scratch_.path("a.h5"), listing)[0].obstacle;
              const std::uint64_t peak = peak_resident_bytes();
              return peak < (std::uint64_t{100} << 20U) ? obstacle.substr(0, 20) : cat(peak, " bytes");
            }),
            "its attributes take ");
}

TEST_F(Hdf5Attribute, MoreBytesInAllThanAreRead_AreAnError) {
  write_by_h5py(scratch_, R"(
with h5py.File("a.h5", "w", libver="latest") as f:
    f["q"] = values("f4"); f["other"] = values("f4")
    f["q"].attrs["description"] = np.bytes_(b"x" * (20 << 20))
    f["q"].attrs["units"] = "K"
with h5py.File("scale.h5", "w", libver="latest") as f:
    f["q"] = values("f4"); f["x"] = np.arange(9.0); f["x"].make_scale("x"); f["q"].dims[2].attach_scale(f["x"])
    f["x"].attrs["history"] = np.bytes_(b"x" * (20 << 20))
)");
  const auto expect_refusal = [&](const std::string& file, const std::string& dataset, const std::string& object) {
    const std::string message =
        message_of_error(ErrorKind::input, [&] { open_source(scratch_.path(file), dataset_options(dataset)); });
    EXPECT_TRUE(message.starts_with(scratch_.path(file) + ": " + object + ": its attributes take 2097")) << message;
    EXPECT_TRUE(
        message.ends_with(" bytes, and at most 16777216 are read; shorten the longest, or make a dataset of it"))
        << message;
  };
  expect_refusal("a.h5", "q", "/q");
  expect_refusal("scale.h5", "q", "/x");
  EXPECT_EQ(open_source(scratch_.path("a.h5"), dataset_options("other"))->info().extent, (Index3{9, 7, 5}));
  SourceOptions listing;
  listing.lists_damaged = true;
  EXPECT_TRUE(list_hdf5(scratch_.path("a.h5"), listing)[1].obstacle.starts_with("its attributes take 2097"));
}

}  // namespace
}  // namespace weir::hdf5_attribute_test
