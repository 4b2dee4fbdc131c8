#include "compressor/options/conversion_request.h"

#include <gtest/gtest.h>

#include <functional>

#include "format/base/error.h"
#include "tests/support/message_of_error.h"

namespace weir::input_options_test {
namespace {

SourceOptions parse(const GivenOptions& given) { return read_conversion_request(given).source; }

std::string message_of(const std::function<void()>& call) {
  return message_of_error(ErrorKind::usage, [&] { call(); });
}

TEST(InputOptions, NoOptionGiven_LeavesAllUnset) {
  const SourceOptions options = parse({});
  EXPECT_FALSE(options.extent || options.type || options.big_endian || options.spacing || options.origin ||
               options.roi);
  EXPECT_FALSE(options.offset || options.missing);
  EXPECT_EQ(options.dataset, "");
  EXPECT_TRUE(options.index.empty());
  EXPECT_EQ(options.direct_io, DirectIo::automatic);
}

TEST(InputOptions, EmptyTexts_AreNotGiven) {
  const SourceOptions options = parse({{"dims", ""}, {"roi", ""}, {"index", ""}, {"type", ""}});
  EXPECT_FALSE(options.extent || options.roi || options.type);
  EXPECT_TRUE(options.index.empty());
}

TEST(InputOptions, SizesAndTypes_AreTakenAsOthersWriteThem) {
  EXPECT_EQ(parse({{"dims", "64x32x16"}}).extent, (Index3{64, 32, 16}));
  for (const auto& [name, type] : {std::pair{"f4", ScalarType::float32},
                                   {"<f4", ScalarType::float32},
                                   {">f8", ScalarType::float64},
                                   {"float", ScalarType::float32},
                                   {"double", ScalarType::float64},
                                   {"|u1", ScalarType::uint8},
                                   {"=i2", ScalarType::int16},
                                   {"f2", ScalarType::float16}}) {
    EXPECT_EQ(parse({{"type", name}}).type, type) << name;
  }
  EXPECT_EQ(parse({{"type", "f4"}}).big_endian, std::nullopt);
  EXPECT_EQ(parse({{"type", "<f4"}}).big_endian, false);
  EXPECT_EQ(parse({{"type", ">f4"}}).big_endian, true);
  EXPECT_EQ(parse({{"type", ">f4"}, {"endian", "big"}}).big_endian, true);
  EXPECT_EQ(parse({{"offset", "2K"}}).offset, 2048U);
  EXPECT_EQ(parse({{"offset", "3M"}}).offset, 3U << 20U);
  EXPECT_EQ(message_of([] {
              parse({{"type", ">f4"}, {"endian", "little"}});
            }),
            "--endian is \"little\", and the byte order that --type names is the other one");
  EXPECT_EQ(message_of([] {
              parse({{"type", "f3"}});
            }),
            "--type is \"f3\", it must be one of uint8, int8, uint16, int16, uint32, int32, uint64, int64, float16, "
            "bfloat16, "
            "float32, float64, or float, double, u1, i1, u2, i2, u4, i4, u8, i8, f2, f4, f8, where < or > before the "
            "name says the byte order");
}

TEST(InputOptions, ImpossibleDims_AreRefused) {
  for (const std::string dims : {"0,4,4", "4,-1,4", "4x4x2147483648", "9223372036854775807,9223372036854775807,4"}) {
    EXPECT_EQ(message_of([&] {
                parse({{"dims", dims}});
              }),
              "--dims is \"" + dims + "\", it must be X,Y,Z, three whole numbers of voxels, each from 1 to 2147483647");
  }
  for (const std::string dims : {"2147483647,2147483647,2147483647", "1048576x1048576x1048576"}) {
    EXPECT_EQ(message_of([&] {
                parse({{"dims", dims}});
              }),
              "--dims is \"" + dims +
                  "\", it must be X,Y,Z, three whole numbers of voxels, with fewer than 2^60 voxels together");
  }
  EXPECT_EQ(parse({{"dims", "1048576x1048576x1048575"}}).extent, (Index3{1 << 20, 1 << 20, (1 << 20) - 1}));
}

TEST(InputOptions, AllGiven) {
  const SourceOptions options = parse({{"dims", "3,4,5"},
                                       {"type", "uint16"},
                                       {"endian", "big"},
                                       {"offset", "1KiB"},
                                       {"spacing", "0.5,1,2e-3"},
                                       {"origin", "-1.5,0,7"},
                                       {"roi", "-1:2,0:4,3:5"},
                                       {"direct-io", "off"},
                                       {"dataset", "/a b/c"},
                                       {"index", "3,0"},
                                       {"component", "y"},
                                       {"level", "2"},
                                       {"upsample", "linear"},
                                       {"missing-chunks", "error"},
                                       {"missing", "-9999"}});
  EXPECT_EQ(options.extent, (Index3{3, 4, 5}));
  EXPECT_EQ(options.type, ScalarType::uint16);
  EXPECT_EQ(options.big_endian, true);
  EXPECT_EQ(options.offset, 1024U);
  EXPECT_EQ(options.spacing, (std::array<double, 3>{0.5, 1, 2e-3}));
  EXPECT_EQ(options.origin, (std::array<double, 3>{-1.5, 0, 7}));
  EXPECT_EQ(options.roi, (Box{{-1, 0, 3}, {2, 4, 5}}));
  EXPECT_EQ(options.direct_io, DirectIo::off);
  EXPECT_EQ(options.dataset, "/a b/c");
  EXPECT_EQ(options.index, (std::vector<std::int64_t>{3, 0}));
  EXPECT_EQ(options.component, (ComponentChoice{false, 1}));
  EXPECT_EQ(options.level, 2);
  EXPECT_EQ(options.upsampling, Upsampling::linear);
  EXPECT_EQ(options.levels, Levels::composite);
  EXPECT_EQ(options.missing_chunks, MissingChunks::error);
  EXPECT_EQ(options.missing, StoredValue{std::int64_t{-9999}});
}

TEST(InputOptions, SeparateLevels_MakeVoxelsWithoutAValueTheBackground) {
  const ConversionRequest request = read_conversion_request({{"levels", "separate"}});
  EXPECT_EQ(request.source.levels, Levels::separate);
  EXPECT_EQ(request.conversion.missing, MissingPolicy::background);
  EXPECT_EQ(message_of([&] {
              read_conversion_request({{"levels", "separate"}, {"nonfinite", "keep"}});
            }),
            "--nonfinite keep does not go with --levels separate, whose voxels without a value become the background; "
            "use background");
}

TEST(InputOptions, MissingPolicy_KeepTellsTheSourceToo) {
  EXPECT_EQ(read_conversion_request({}).conversion.missing, MissingPolicy::automatic);
  EXPECT_FALSE(parse({{"missing-policy", "background"}}).keeps_missing);
  EXPECT_TRUE(parse({{"missing-policy", "keep"}}).keeps_missing);
  EXPECT_EQ(read_conversion_request({{"missing-policy", "keep"}}).conversion.missing, MissingPolicy::keep);
}

TEST(InputOptions, Dims) {
  const std::string form = ", it must be X,Y,Z, three whole numbers of voxels";
  for (const std::string text : {"3,4", "3,4,5,6", "3x4,5", "3,4,", "3,4,5.5", "3,4,99999999999999999999"}) {
    EXPECT_EQ(message_of([&] { parse({{"dims", text}}); }), "--dims is \"" + text + "\"" + form);
  }
}

TEST(InputOptions, Type) {
  EXPECT_EQ(message_of([] {
              parse({{"type", "half"}});
            }),
            "--type is \"half\", it must be one of uint8, int8, uint16, int16, uint32, int32, uint64, int64, float16, "
            "bfloat16, "
            "float32, float64, or float, double, u1, i1, u2, i2, u4, i4, u8, i8, f2, f4, f8, where < or > before the "
            "name says the byte order");
}

TEST(InputOptions, Endian) {
  EXPECT_EQ(message_of([] { parse({{"endian", "middle"}}); }), "--endian is \"middle\", it must be little or big");
}

TEST(InputOptions, Offset) {
  EXPECT_EQ(message_of([] {
              parse({{"offset", "0.3"}});
            }),
            "--offset is \"0.3\", it must be a number of bytes, like 352 or 4KiB");
}

TEST(InputOptions, SpacingAndOrigin) {
  EXPECT_EQ(message_of([] {
              parse({{"spacing", "1,2"}});
            }),
            "--spacing is \"1,2\", it must be x,y,z, three numbers in world units");
  EXPECT_EQ(message_of([] {
              parse({{"origin", "1,2,3,4"}});
            }),
            "--origin is \"1,2,3,4\", it must be x,y,z, three numbers in world units");
  EXPECT_EQ(message_of([] {
              parse({{"origin", "1,two,3"}});
            }),
            "--origin is \"1,two,3\", it must be x,y,z, three numbers in world units");
}

TEST(InputOptions, Index) {
  for (const std::string text : {"1,", "a", "1.5", "=2"}) {
    EXPECT_EQ(message_of([&] {
                parse({{"index", text}});
              }),
              "--index is \"" + text +
                  "\", it must be i,j,..., whole numbers, below 0 from the end, FROM:TO or * for several, or AXIS=i");
  }
  EXPECT_EQ(parse({{"index", "2,0"}}).index, (std::vector<std::int64_t>{2, 0}));
  const SourceOptions choices = parse({{"index", "time=-1,level=0:2"}});
  EXPECT_TRUE(choices.index.empty());
  EXPECT_EQ(choices.index_choices, (std::vector<AxisChoice>{{"time", false, -1, std::nullopt}, {"level", true, 0, 2}}));
}

TEST(InputOptions, Missing_ThatIsNoNumberIsRefused) {
  EXPECT_EQ(message_of([] { parse({{"missing", "none"}}); }), "--missing is \"none\", it must be a number or nan");
  EXPECT_EQ(parse({{"missing", "18446744073709551615"}}).missing, StoredValue{~std::uint64_t{0}});
}

TEST(InputOptions, Roi) {
  const std::string form = ", it must be x0:x1,y0:y1,z0:z1, whole numbers, x0 inclusive, x1 exclusive";
  for (const std::string text : {"1:2,3:4", "1:2,3:4,5", "1:2,3:4,5:6:7", "a:2,3:4,5:6", "1:2,3:4,5:6,7:8"}) {
    EXPECT_EQ(message_of([&] { parse({{"roi", text}}); }), "--roi is \"" + text + "\"" + form);
  }
  EXPECT_EQ(message_of([] {
              parse({{"roi", "1:1,3:4,5:6"}});
            }),
            "--roi is \"1:1,3:4,5:6\"" + form + ", with every end above its start");
  const VolumeRegion open = parse({{"roi", "2:,:-3,:"}}).roi.value();
  EXPECT_EQ(open.in({{0, 0, 0}, {10, 10, 10}}), (Box{{2, 0, 0}, {10, 7, 10}}));
}

TEST(InputOptions, Ghost_LeavesLayersOutAtBothEnds) {
  const Box domain{{-3, 0, 5}, {7, 10, 15}};
  EXPECT_EQ(parse({{"ghost", "2"}}).roi.value().in(domain), (Box{{-1, 2, 7}, {5, 8, 13}}));
  EXPECT_EQ(parse({{"ghost", "0,1,4"}}).roi.value().in(domain), (Box{{-3, 1, 9}, {7, 9, 11}}));
  EXPECT_EQ(parse({{"ghost", "0"}}).roi.value().in(domain), domain);
}

TEST(InputOptions, DirectIo_OfAnotherWordIsRefused) {
  EXPECT_EQ(message_of([] {
              parse({{"direct-io", "maybe"}});
            }),
            "--direct-io is \"maybe\", it must be auto, on or off");
}

}  // namespace
}  // namespace weir::input_options_test
