// Tests what is read from the metadata of arrays, in Zarr 2 and Zarr 3, and which metadata are refused.
#include "ingest/zarr/metadata/array_v2.h"
#include "ingest/zarr/metadata/array_v3.h"
#include "ingest/zarr/metadata/fill_value.h"
#include "ingest/zarr/metadata/zarr_json.h"
#include "tests/ingest/zarr/support/zarr_files.h"

namespace weir::array_metadata_test {
namespace {

ZarrArray v2(std::string_view text) { return parse_zarr_v2(parse_zarr_json(text, "a"), {}, "a"); }
ZarrArray v3(std::string_view text) { return parse_zarr_v3(parse_zarr_json(text, "a"), "a"); }

std::string refusal_v2(std::string_view text) {
  return message_of_error(ErrorKind::input, [&] { v2(text); });
}
std::string refusal_v3(std::string_view text) {
  return message_of_error(ErrorKind::input, [&] { v3(text); });
}
std::string refusal_of_codecs(std::string_view codecs) { return refusal_v3(zarr_json("[4,4,4]", "[4,4,4]", codecs)); }

std::vector<std::byte> bytes(std::initializer_list<int> values) {
  std::vector<std::byte> all;
  for (const int value : values) all.push_back(static_cast<std::byte>(value));
  return all;
}

TEST(ZarrMetadata, Version2_IsReadAsItIsWritten) {
  const ZarrArray array =
      v2(zarray("[10,20,30]", "[4,5,6]", ">f4", "1.5",
                R"("compressor":{"id":"blosc","cname":"lz4"},"filters":[],"dimension_separator":"/")"));
  EXPECT_EQ(array.shape, (std::vector<std::int64_t>{10, 20, 30}));
  EXPECT_EQ(array.chunk, (std::vector<std::int64_t>{4, 5, 6}));
  EXPECT_EQ(array.type, ScalarType::float32);
  EXPECT_TRUE(array.codecs.big_endian);
  EXPECT_EQ(array.codecs.packers, std::vector{ZarrPacker::blosc});
  EXPECT_EQ(array.keys.key(std::array<std::int64_t, 3>{0, 1, 2}), "0/1/2");
  EXPECT_EQ(array.fill, bytes({0x3F, 0xC0, 0, 0}));
  EXPECT_EQ(array.layout_text(), "chunked 4 x 5 x 6, blosc");
}

TEST(ZarrMetadata, Version2_WhatIsNotReadIsNamed) {
  EXPECT_EQ(refusal_v2(zarray("[1,1,1]", "[1,1]")), "a: chunks has 2 axes, and shape has 3; the file is damaged");
  EXPECT_EQ(
      refusal_v2(zarray("[1,1,-1]", "[1,1,1]")),
      "a: shape is one with -1, and must be a list of whole numbers from 0 on, one for each of at most 32 axes; the "
      "file is damaged");
  EXPECT_EQ(
      refusal_v2(zarray("[1,1,1]", "[1,0,1]")),
      "a: chunks is one with 0, and must be a list of whole numbers from 1 on, one for each of at most 32 axes; the "
      "file is damaged");
  EXPECT_EQ(refusal_v2(zarray("[1,1,1]", "[1,1,1]", "<M8[ns]")),
            "a: its type is <M8[ns]; a volume has integers of 8 to 64 bits or floats of 16, 32 or 64");
  EXPECT_EQ(refusal_v2(R"({"zarr_format":2,"shape":[1],"chunks":[1],"dtype":[["r","|u1"]]})"),
            "a: its type is a structure; a volume has integers of 8 to 64 bits or floats of 16, 32 or 64");
  EXPECT_EQ(refusal_v2(zarray("[1,1,1]", "[1,1,1]", "<f4", "0", R"("compressor":{"id":"lzma"})")),
            "a: has the compressor 'lzma', and weir reads zlib, gzip, zstd, blosc and crc32c; write the array with one "
            "of them");
  const auto filter = [](std::string_view filters) {
    return refusal_v2(zarray("[1,1,1]", "[1,1,1]", "<f4", "0", cat("\"filters\":[", filters, "]")));
  };
  EXPECT_EQ(filter(R"({"id":"fixedscaleoffset","scale":10})"),
            "a: has the filter 'fixedscaleoffset', and weir undoes delta and shuffle; write the array without it");
  for (const auto& [filters, shown] :
       {std::pair(R"({"id":"delta","dtype":"<f4"})", "an object of 2"), std::pair(R"("delta")", R"("delta")")}) {
    EXPECT_EQ(refusal_v2(zarray("[1,1,1]", "[1,1,1]", "<f4", "0", cat("\"filters\":", filters))),
              cat("a: filters is ", shown, ", and must be null or a list; the file is damaged"));
  }
  EXPECT_EQ(filter(R"({"id":"delta","dtype":"<f4","astype":"<i2"})"),
            "a: has the filter 'delta' from <f4 to <i2, and it is undone of one type, an integer or float32 or float64 "
            "as wide as the array's; write the array without it");
  EXPECT_EQ(filter(R"({"id":"delta","dtype":"<f8"})"),
            "a: has the filter 'delta' from <f8 to <f8, and it is undone of one type, an integer or float32 or float64 "
            "as wide as the array's; write the array without it");
  EXPECT_EQ(
      filter(R"({"id":"shuffle","elementsize":0})"),
      "a: elementsize of the filter 'shuffle' is 0, and must be a whole number from 1 to 256; the file is damaged");
  EXPECT_EQ(refusal_v2(zarray("[1,1,1]", "[1,1,1]", "<f4", "0", R"("dimension_separator":"-")")),
            "a: dimension_separator is \"-\", and must be \".\" or \"/\"; the file is damaged");
  EXPECT_EQ(refusal_v2("{\"zarr_format\":2,"), "a: is no JSON at byte 18; the file is damaged or still being written");
  EXPECT_EQ(refusal_v2("[2]"), "a: is no JSON object; the file is damaged");
}

TEST(ZarrMetadata, Version2_FiltersAndBool_AreReadAsTheyAreWritten) {
  const ZarrArray array = v2(zarray("[9,9,9]", "[3,3,3]", ">i4", "0",
                                    R"("filters":[{"id":"delta","dtype":">i4","astype":">i4"},{"id":"shuffle"}])"));
  ASSERT_EQ(array.codecs.filters.size(), 2U);
  EXPECT_EQ(array.codecs.filters[0].type, ScalarType::int32);
  EXPECT_TRUE(array.codecs.filters[0].big_endian);
  EXPECT_EQ(array.codecs.filters[1].value_bytes, 4U) << "what numcodecs takes where nothing is said";
  EXPECT_EQ(array.layout_text(), "chunked 3 x 3 x 3, delta, shuffle");
  EXPECT_EQ(v2(zarray("[9,9,9]", "[3,3,3]", "|b1", "true")).fill, bytes({1}));
  EXPECT_EQ(v3(zarr_json("[9,9,9]", "[3,3,3]", R"([{"name":"bytes"}])", "bool", "false")).fill, bytes({0}));
  EXPECT_EQ(refusal_v2(zarray("[9,9,9]", "[3,3,3]", "|b1", "2")),
            "a: fill_value is 2, and of an array of bool it must be true or false; the file is damaged");
}

TEST(ZarrMetadata, FillValues_AreReadInEveryForm) {
  const auto fill = [](const nlohmann::json& value, ScalarType type, bool big = false) {
    return fill_bytes(value, type, big, "a");
  };
  EXPECT_EQ(fill("NaN", ScalarType::float16), bytes({0x00, 0x7E}));
  EXPECT_EQ(fill("-Infinity", ScalarType::float32, true), bytes({0xFF, 0x80, 0, 0}));
  EXPECT_EQ(fill("Infinity", ScalarType::float64, true), bytes({0x7F, 0xF0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(fill("0x7fc00001", ScalarType::float32), bytes({0x01, 0x00, 0xC0, 0x7F}));
  EXPECT_EQ(fill("AACAPw==", ScalarType::float32), bytes({0x00, 0x00, 0x80, 0x3F})) << "base64, as stored";
  EXPECT_EQ(fill(-2, ScalarType::int16, true), bytes({0xFF, 0xFE}));
  EXPECT_EQ(fill(std::uint64_t{18446744073709551615U}, ScalarType::uint64), std::vector(8, std::byte{0xFF}));
  EXPECT_EQ(fill(3.0, ScalarType::uint8), bytes({3})) << "a whole number, written as another";
  EXPECT_EQ(fill(1.5, ScalarType::float16), bytes({0x00, 0x3E}));
  EXPECT_EQ(fill(65504, ScalarType::float16, true), bytes({0x7B, 0xFF}));
  EXPECT_EQ(fill(3.140625, ScalarType::bfloat16, true), bytes({0x40, 0x49}));
  EXPECT_EQ(fill("NaN", ScalarType::bfloat16, true), bytes({0x7F, 0xC0}));
  EXPECT_EQ(fill(5.960464477539063e-08, ScalarType::float16, true), bytes({0x00, 0x01})) << "the least of all halves";
  for (const nlohmann::json& wrong :
       {nlohmann::json(256), nlohmann::json(1.5), nlohmann::json("NaN"), nlohmann::json("0x100"), nlohmann::json("?"),
        nlohmann::json(true), nlohmann::json::array()}) {
    const std::string message = message_of_error(ErrorKind::input, [&] { fill(wrong, ScalarType::uint8); });
    EXPECT_EQ(message, "a: fill_value is " + json_text(wrong) + ", which is no uint8; the file is damaged");
  }
}

TEST(ZarrMetadata, NumbersThatOnlyPythonWrites_AreRead) {
  const nlohmann::json document =
      parse_zarr_json(R"({"a":NaN,"b":[Infinity,-Infinity],"c":"is NaN, \"NaN\"","d":1})", "a");
  EXPECT_EQ(document.dump(), R"({"a":"NaN","b":["Infinity","-Infinity"],"c":"is NaN, \"NaN\"","d":1})");
}

TEST(ZarrMetadata, NestedTooDeep_IsRefusedBeforeItIsParsed) {
  EXPECT_EQ(message_of_error(ErrorKind::input, [] { parse_zarr_json("{\"a\":" + std::string(1000000, '['), "a"); }),
            "a: has more than 64 lists and objects in each other at byte 68; the file is damaged");
}

TEST(ZarrMetadata, MoreValuesThanTheLimit_AreRefused) {
  const auto text = [](std::size_t values) {
    std::string zeros = "0";
    for (std::size_t i = 3; i < values; ++i) zeros += ",0";  // the document and the list count as values, too
    return cat(R"({"a":[)", zeros, "]}");
  };
  EXPECT_EQ(json_values(parse_zarr_json(text(kMostMetadataValues), "a")), kMostMetadataValues);
  EXPECT_EQ(
      message_of_error(ErrorKind::input, [&] { parse_zarr_json(text(kMostMetadataValues + 1), "a"); }),
      "a: has more than 100000 JSON values, the most that metadata may have; write long lists in its attributes as "
      "arrays");
}

TEST(ZarrMetadata, ConsolidatedMetadata_AreLeftOutAndNotCounted) {
  std::string copies = R"("a/b":{"consolidated_metadata":null,"shape":[1,2]})";
  for (int i = 0; i < 20000; ++i) copies += cat(R"(,"a/)", i, R"(":{"shape":[1,{"x":[]},3]})");
  const nlohmann::json document =
      parse_zarr_json(cat(R"({"zarr_format":3,"consolidated_metadata":{"kind":"inline","metadata":{)", copies,
                          R"(}},"attributes":{"consolidated_metadata":[4]}})"),
                      "a");
  EXPECT_EQ(document.dump(), R"({"attributes":{"consolidated_metadata":[4]},"zarr_format":3})");
  EXPECT_EQ(parse_zarr_json(R"({"consolidated_metadata":null,"a":[1]})", "a").dump(), R"({"a":[1]})");
}

TEST(ZarrMetadata, Version3_IsReadAsItIsWritten) {
  const ZarrArray array = v3(zarr_json(
      "[10,20,30]", "[4,5,6]",
      R"([{"name":"transpose","configuration":{"order":[2,0,1]}},{"name":"transpose","configuration":{"order":[1,0,2]}},)"
      R"({"name":"bytes","configuration":{"endian":"big"}},"zstd",{"name":"crc32c"}])",
      "int16", "-1", R"(,"dimension_names":["z",null,"x"],"extra":{"must_understand":false})"));
  EXPECT_EQ(array.codecs.transpose, (std::vector<std::size_t>{0, 2, 1})) << "both steps in one";
  EXPECT_TRUE(array.codecs.big_endian);
  EXPECT_EQ(array.codecs.packers, (std::vector{ZarrPacker::zstd, ZarrPacker::crc32c}));
  EXPECT_EQ(array.keys.key(std::array<std::int64_t, 3>{0, 1, 2}), "c/0/1/2");
  EXPECT_EQ(array.axis_names, (std::vector<std::string>{"z", "", "x"}));
  EXPECT_EQ(array.layout_text(), "chunked 4 x 5 x 6, transposed, zstd, crc32c");
}

TEST(ZarrMetadata, Version3_WhatIsNotReadIsNamed) {
  EXPECT_EQ(refusal_v3(zarr_json("[1,1,1]", "[1,1,1]", R"([{"name":"bytes"}])", "complex64")),
            "a: its type is complex64; a volume has integers of 8 to 64 bits or floats of 16, 32 or 64");
  EXPECT_EQ(refusal_v3(zarr_json("[1,1,1]", "[1,1,1]", R"([{"name":"bytes"}])", "uint8", "0",
                                 R"(,"storage_transformers":[{"name":"mirror"}])")),
            "a: has the storage transformer 'mirror', and none is read here; write the array without");
  EXPECT_EQ(refusal_v3(zarr_json("[1,1,1]", "[1,1,1]", R"([{"name":"bytes"}])", "uint8", "0", R"(,"new":{})")),
            "a: has the member 'new', which weir does not know and must understand");
  EXPECT_EQ(refusal_v3(R"({"zarr_format":3,"node_type":"array","shape":[1],"data_type":"int8","chunk_grid":"ragged"})"),
            "a: has the chunk grid 'ragged', and only regular ones are read; write the array with chunks of one shape");
}

TEST(ZarrMetadata, Version3_DimensionNamesOfAnotherNumberThanAxes_AreRefused) {
  const auto named = [](std::string_view names) {
    return zarr_json("[1,1,1]", "[1,1,1]", R"([{"name":"bytes"}])", "uint8", "0", cat(",\"dimension_names\":", names));
  };
  const auto refused = [](std::string_view found) {
    return cat("a: dimension_names is ", found,
               ", and must be a list of one name or null for each of the 3 axes of shape; the file is damaged");
  };
  EXPECT_EQ(refusal_v3(named(R"(["y","x"])")), refused("a list of 2"));
  EXPECT_EQ(refusal_v3(named(R"(["z","y",1])")), refused("a list of 3"));
  EXPECT_EQ(refusal_v3(named("\"zyx\"")), refused("\"zyx\""));
  EXPECT_EQ(v3(named("null")).axis_names, std::vector<std::string>(3));
}

TEST(ZarrMetadata, Version2_DimensionsOfAnotherNumberThanAxes_NameNone) {
  const ZarrArray array =
      parse_zarr_v2(parse_zarr_json(zarray("[1,1,1]", "[1,1,1]"), "a"), {{"_ARRAY_DIMENSIONS", {"y", "x"}}}, "a");
  EXPECT_EQ(array.axis_names, std::vector<std::string>(3));
}

TEST(ZarrMetadata, Version3_CodecsOutOfPlaceAreRefused) {
  EXPECT_EQ(refusal_of_codecs("[]"),
            "a: codecs is a list of 0, and must be a list of 1 to 16 codecs; the file is damaged");
  EXPECT_EQ(refusal_of_codecs(R"([{"name":"gzip"},{"name":"bytes"}])"),
            "a: has the codec 'gzip' where the codec bytes must stand before it; the file is damaged");
  EXPECT_EQ(refusal_of_codecs(R"([{"name":"bytes"},{"name":"bytes"}])"),
            "a: has the codec 'bytes' where only codecs of bytes can stand; the file is damaged");
  EXPECT_EQ(refusal_of_codecs(R"([{"name":"vlen-utf8"}])"),
            "a: has the codec 'vlen-utf8', and weir reads zlib, gzip, zstd, blosc and crc32c; write the array with one "
            "of them");
  EXPECT_EQ(refusal_of_codecs(R"([{"name":"transpose","configuration":{"order":[0,1,1]}},{"name":"bytes"}])"),
            "a: the order of transpose names not each of the 3 axes once; the file is damaged");
  const auto shards = [](std::string_view chunk, std::string_view index,
                         std::string_view inner = R"({"name":"bytes"})") {
    return cat(R"([{"name":"sharding_indexed","configuration":{"chunk_shape":)", chunk, R"(,"codecs":[)", inner,
               R"(],"index_codecs":)", index, "}}]");
  };
  const std::string index = R"([{"name":"bytes","configuration":{"endian":"little"}},{"name":"crc32c"}])";
  EXPECT_EQ(
      refusal_of_codecs(shards("[4,4,3]", index)),
      "a: its shards have 4 elements along axis 2, and the chunks in them 3, which does not divide that; the file "
      "is damaged");
  EXPECT_EQ(refusal_of_codecs(shards("[4,4,2]", R"([{"name":"bytes","configuration":{"endian":"little"}},"gzip"])")),
            "a: index_codecs has 'gzip', and weir reads indices with bytes and crc32c; write the array with those");
  EXPECT_EQ(refusal_of_codecs(shards("[4,4,2]", index, R"({"name":"sharding_indexed"},"gzip")")),
            "a: has other codecs beside sharding_indexed; write the array with those inside");
  const auto inside = [&](const std::string& list) { return list.substr(1, list.size() - 2); };
  EXPECT_EQ(
      refusal_of_codecs(shards("[4,4,2]", index, inside(shards("[4,4,3]", index)))),
      "a: its shards have 2 elements along axis 2, and the chunks in them 3, which does not divide that; the file "
      "is damaged");
  std::string deep = R"({"name":"bytes"})";
  for (int level = 0; level < 5; ++level) deep = inside(shards("[4,4,4]", index, deep));
  EXPECT_EQ(refusal_of_codecs(cat('[', deep, ']')),
            "a: has more than 4 levels of shards in each other; write the array with fewer");
}

}  // namespace
}  // namespace weir::array_metadata_test
