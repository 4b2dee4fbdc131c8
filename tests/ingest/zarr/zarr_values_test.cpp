// Tests what the attributes of a Zarr array say about its values, by the conventions of CF.

#include <cmath>

#include "ingest/zarr/meaning/array_meaning.h"
#include "ingest/zarr/zarr_source.h"
#include "tests/ingest/zarr/support/zarr_files.h"

namespace weir::zarr_values_test {
namespace {

TEST(ZarrValues, ScaleAndMissingValueOfXarray_AreApplied) {
  const ZarrFiles files;
  files.write(".zarray", zarray("[1,1,3]", "[1,1,3]", "|u1", "255"));
  files.write(".zattrs", R"({"_ARRAY_DIMENSIONS":["z","y","x"],"scale_factor":0.5,"add_offset":-1,"missing_value":255,)"
                         R"("units":"K","long_name":"temperature","valid_max":NaN})");
  files.write_values("0.0.0", std::vector<std::uint8_t>{0, 4, 255});
  const auto source = open_source(files.path(), {});
  const std::vector<float> values = ZarrFiles::read_all(*source);
  EXPECT_EQ(values[0], -1.0F);
  EXPECT_EQ(values[1], 1.0F);
  EXPECT_TRUE(is_missing(values[2]));
  EXPECT_EQ(source->info().units, "K");
  EXPECT_EQ(source->info().details.long_name, "temperature");
}

/// Writes an array of two values, -999 and 1.5, with `attributes`.
void write_floats(const ZarrFiles& files, std::string_view attributes) {
  files.write("zarr.json", zarr_json("[1,1,2]", "[1,1,2]", R"([{"name":"bytes","configuration":{"endian":"little"}}])",
                                     "float32", "0", cat(R"(,"attributes":)", attributes)));
  files.write_values("c/0/0/0", std::vector<float>{-999, 1.5F});
}

std::vector<float> read_floats(const ZarrFiles& files, std::string_view attributes) {
  write_floats(files, attributes);
  return files.read();
}

TEST(ZarrValues, ValuesThatHoldNoData_AreKnownAsNumbersListsTextsAndInBase64) {
  const ZarrFiles files;
  // xarray writes _FillValue of floats in version 3 as the base64 of a double.
  for (const char* attributes :
       {R"({"_FillValue":-999})", R"({"_FillValue":"AAAAAAA4j8A="})", R"({"missing_value":[5,-999.0]})",
        R"({"missing_value":"-999"})", R"({"_FillValue":["-999",5]})"}) {
    const std::vector<float> values = read_floats(files, attributes);
    EXPECT_TRUE(is_missing(values[0])) << attributes;
    EXPECT_EQ(values[1], 1.5F) << attributes;
  }
}

TEST(ZarrValues, ValuesThatHoldNoDataAndAreNoNumbers_AreRefused) {
  const ZarrFiles files;
  const std::string end = ", so which voxels hold no data is unknown; correct or remove it";
  for (const auto& [attributes, found] : {std::pair(R"({"_FillValue":"AAAAAAA4j8A"})", R"(is "AAAAAAA4j8A" and)"),
                                          std::pair(R"({"_FillValue":"AAAAAAA4j8?="})", R"(is "AAAAAAA4j8?=" and)"),
                                          std::pair(R"({"_FillValue":"none"})", R"(is "none" and)"),
                                          std::pair(R"({"_FillValue":{"a":-999}})", "is an object of 1 and"),
                                          std::pair(R"({"_FillValue":[-999,"x",{}]})", R"(has "x", which is)")}) {
    write_floats(files, attributes);
    EXPECT_EQ(files.message(ErrorKind::input), cat("run.zarr: its attribute _FillValue ", found, " not a number", end));
  }
  EXPECT_EQ(list_zarr(files.path(), {})[0].obstacle,
            R"(its attribute _FillValue has "x", which is not a number)" + end);
}

TEST(ZarrValues, ValuesThatTheTypeDoesNotHave_AreSaidAndMarkNothing) {
  const ZarrFiles files;
  files.write_values("0.0.0", std::vector<std::uint8_t>{0, 255});
  const auto note = [&](std::string_view type, std::string_view attributes) {
    files.write(".zarray", zarray("[1,1,2]", type == "|u1" ? "[1,1,2]" : "[1,1,1]", type, "0"));
    files.write(".zattrs", attributes);
    const auto source = open_source(files.path(), {});
    return source->info().details.values_note;
  };
  const auto said = [](std::string_view name, std::string_view value, std::string_view type) {
    return cat("its attribute ", name, " is ", value, ", and no ", type,
               " is, so it marks no voxel; --missing names the stored value that stands for no data");
  };
  EXPECT_EQ(note("|u1", R"({"_FillValue":-1})"), said("_FillValue", "-1", "uint8"));
  EXPECT_EQ(note("|u1", R"({"missing_value":[255,300]})"), said("missing_value", "300", "uint8"));
  EXPECT_EQ(note("|u1", R"({"_FillValue":255.5})"), said("_FillValue", "255.5", "uint8"));
  EXPECT_EQ(files.read(), (std::vector<float>{0, 255}));
  EXPECT_EQ(note("<i2", R"({"missing_value":-999999.0,"scale_factor":0.5})"),
            said("missing_value", "-999999", "int16"));
  EXPECT_EQ(note("|u1", R"({"_FillValue":-1,"_Unsigned":"true"})"), "") << "255 as it is stored";
  EXPECT_EQ(note("|u1", R"({"_FillValue":255.0})"), "");
}

TEST(ZarrValues, ValidRange_IsSaidNotToBeApplied) {
  const ZarrFiles files;
  for (const std::string name : {"valid_range", "valid_min", "valid_max"}) {
    write_floats(files, cat("{\"", name, R"(":0,"units":"K"})"));
    const std::string said = cat("its attribute ", name, " is not applied: values outside it count as data");
    EXPECT_EQ(open_source(files.path(), {})->info().details.values_note, said);
    const std::vector<DatasetInfo> listed = list_zarr(files.path(), {});
    EXPECT_EQ(listed[0].attributes.back(), std::pair(std::string("note"), said));
  }
}

// In Zarr 2, xarray writes _FillValue as the fill_value of .zarray, and null if there is no _FillValue.
TEST(ZarrValues, FillValueOfXarrayInVersion2_HoldsNoData) {
  const ZarrFiles files;
  const auto read = [&](std::string_view type, std::string_view fill, std::string_view attributes) {
    files.write(".zarray", zarray("[1,1,2]", "[1,1,2]", type, fill));
    files.write(".zattrs", attributes);
    return files.read();
  };
  constexpr std::string_view kNamed = R"({"_ARRAY_DIMENSIONS":["z","y","x"]})";
  files.write_values("0.0.0", std::vector<std::int16_t>{-32768, 2});
  std::vector<float> values =
      read("<i2", "-32768", R"({"_ARRAY_DIMENSIONS":["z","y","x"],"scale_factor":0.5,"add_offset":300})");
  EXPECT_TRUE(is_missing(values[0])) << values[0];
  EXPECT_EQ(values[1], 301.0F);
  values = read("<u2", "32768", kNamed);
  EXPECT_TRUE(is_missing(values[0])) << values[0];
  EXPECT_TRUE(is_missing(read("<i2", "-32768", R"({"_ARRAY_DIMENSIONS":["z","y","x"],"_Unsigned":"true"})")[0]));
  EXPECT_EQ(read("<i2", "null", kNamed), (std::vector<float>{-32768, 2}));
  EXPECT_EQ(read("<i2", "-32768", "{}"), (std::vector<float>{-32768, 2})) << "not of xarray";
  values = read("<i2", "-32768", R"({"_ARRAY_DIMENSIONS":["z","y","x"],"_FillValue":2})");
  EXPECT_EQ(values[0], -32768.0F) << "the attribute says it";
  EXPECT_TRUE(is_missing(values[1]));
  files.write_values("0.0.0", std::vector<float>{std::nanf(""), 1.5F});
  values = read("<f4", R"("NaN")", kNamed);
  EXPECT_TRUE(is_missing(values[0]));
  EXPECT_EQ(values[1], 1.5F);
  files.write_values("0.0.0", std::vector<std::uint16_t>{0xE3D0, 0x3E00});  // -1000 (-999.9 rounds to it) and 1.5
  values = read("<f2", "-999.9", kNamed);
  EXPECT_TRUE(is_missing(values[0])) << values[0];
  EXPECT_EQ(values[1], 1.5F);
}

TEST(ZarrValues, SignedIntegersMeantAsUnsigned_AreReadSo) {
  const ZarrFiles files;
  files.write("zarr.json", zarr_json("[1,1,4]", "[1,1,3]", R"([{"name":"bytes"}])", "int8", "-56",
                                     R"(,"attributes":{"_Unsigned":"true","_FillValue":-1,"scale_factor":2})"));
  files.write_values("c/0/0/0", std::vector<std::uint8_t>{1, 255, 129});
  const auto source = open_source(files.path(), {});
  const std::vector<float> values = ZarrFiles::read_all(*source);
  EXPECT_EQ(source->info().type, ScalarType::uint8);
  EXPECT_EQ(values[0], 2.0F);
  EXPECT_TRUE(is_missing(values[1]));
  EXPECT_EQ(values[2], 258.0F);
  EXPECT_EQ(values[3], 400.0F);
  EXPECT_EQ(source->info().details.chunks_note, "1 of its 2 chunks is not stored and reads as its fill value, 200");
  EXPECT_EQ(list_zarr(files.path(), {})[0].type, "uint8");
}

TEST(ZarrValues, ScalesThatAreNotOneNumber_AreRefused) {
  const ZarrFiles files;
  EXPECT_EQ(read_floats(files, R"({"scale_factor":"0.5","add_offset":[1]})"), (std::vector<float>{-498.5F, 1.75F}));
  const auto refusal = [&](std::string_view attributes) {
    write_floats(files, attributes);
    return files.message(ErrorKind::input);
  };
  const std::string end = ", so what its values mean is unknown; correct or remove it";
  EXPECT_EQ(refusal(R"({"scale_factor":"half"})"),
            "run.zarr: its attribute scale_factor is \"half\" and not one finite number other than 0" + end);
  EXPECT_EQ(refusal(R"({"scale_factor":0})"),
            "run.zarr: its attribute scale_factor is 0 and not one finite number other than 0" + end);
  EXPECT_EQ(refusal(R"({"add_offset":NaN})"),
            "run.zarr: its attribute add_offset is \"NaN\" and not one finite number" + end);
  EXPECT_EQ(refusal(R"({"add_offset":[1,"x"]})"),
            "run.zarr: its attribute add_offset is a list of 2 and not one finite number" + end);
  EXPECT_EQ(list_zarr(files.path(), {})[0].obstacle,
            "its attribute add_offset is a list of 2 and not one finite number" + end);
}

}  // namespace
}  // namespace weir::zarr_values_test
