#include "ingest/meta_image/meta_image_source.h"

#include <filesystem>

#include "format/base/text.h"
#include "ingest/source_registry.h"
#include "tests/ingest/support/header_file.h"
#include "tests/ingest/support/packed.h"

namespace weir::meta_image_source_test {
namespace {

std::vector<std::uint8_t> ramp() {
  std::vector<std::uint8_t> values(24);
  for (std::size_t i = 0; i < 24; ++i) values[i] = static_cast<std::uint8_t>(i);
  return values;
}

std::string header(const std::string& entries, const std::string& data_file = "LOCAL") {
  return "ObjectType = Image\nNDims = 3\nDimSize = 4 3 2\nElementType = MET_UCHAR\n" + entries +
         "ElementDataFile = " + data_file + "\n";
}

std::string refusal(const std::string& path) {
  return message_of_error(ErrorKind::input, [&] { open_source(path, {}); });
}

template <typename T>
void expect_type(const std::string& name) {
  const Scratch scratch;
  const auto values = telling_values<T>(24);
  for (const bool big : {false, true}) {
    for (const bool compressed : {false, true}) {
      auto bytes = stored(values, big);
      if (compressed) bytes = deflated(bytes, Wrapper::zlib);
      std::string text = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = ";
      text += big ? "True\n" : "False\n";
      if (compressed) text += "CompressedData = True\nCompressedDataSize = " + std::to_string(bytes.size()) + "\n";
      text += "DimSize = 4 3 2\nElementType = " + name + "\nElementDataFile = LOCAL\n";
      const std::string path = write_headed(scratch, "a.mha", text, bytes);
      const auto source = open_source(path, {});
      EXPECT_EQ(source->info().format, "meta-image");
      EXPECT_EQ(source->info().extent, (Index3{4, 3, 2}));
      EXPECT_EQ(source->info().file_bytes, std::filesystem::file_size(path));
      EXPECT_EQ(read_volume(*source), as_floats(values)) << name << big << compressed;
    }
  }
}

TEST(MetaImageSource, ReadsEveryTypeInBothByteOrdersPlainAndPacked) {
  expect_type<std::int8_t>("MET_CHAR");
  expect_type<std::uint8_t>("MET_UCHAR");
  expect_type<std::int16_t>("MET_SHORT");
  expect_type<std::uint16_t>("MET_USHORT");
  expect_type<std::int32_t>("MET_INT");
  expect_type<std::uint32_t>("MET_UINT");
  expect_type<std::int32_t>("MET_LONG");
  expect_type<std::uint32_t>("MET_ULONG");
  expect_type<std::int64_t>("MET_LONG_LONG");
  expect_type<std::uint64_t>("MET_ULONG_LONG");
  expect_type<float>("MET_FLOAT");
  expect_type<double>("MET_DOUBLE");
}

TEST(MetaImageSource, TakesPlaceAndIntensity) {
  const Scratch scratch;
  const std::string path =
      write_headed(scratch, "a.mha",
                   header("ElementSpacing = 0.5 0.25 2\nOffset = -10 20 5\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n"
                          "ElementToIntensityFunctionSlope = 0.5\nElementToIntensityFunctionOffset = -1\n"),
                   stored(ramp()));
  const auto source = open_source(path, {});
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{0.5, 0.25, 2}));
  EXPECT_EQ(source->info().origin, (std::array<double, 3>{-10, 20, 5}));
  EXPECT_EQ(read_volume(*source)[23], 10.5F);
}

TEST(MetaImageSource, DistanceUnits_AreOfAllAxes) {
  const Scratch scratch;
  const auto path = [&](const std::string& units) {
    return write_headed(scratch, "a.mha", header("DistanceUnits = " + units + "\n"), stored(ramp()));
  };
  const SourceInfo info = open_source(path("mm"), {})->info();
  for (const AxisDetails& axis : info.details.axes) EXPECT_EQ(axis.units, "mm");
  EXPECT_EQ(info.details.units_note, "");
  EXPECT_EQ(list_meta_image(path("um"), {}).at(0).attributes.back(),
            (std::pair<std::string, std::string>{"length unit", "um"}));
  EXPECT_EQ(open_source(path("?"), {})->info().details.axes[0].units, "") << "MetaIO's word for unknown";
}

TEST(MetaImageSource, SpacingIgnoresTheAxisDirections) {
  const Scratch scratch;
  // A rotation by 36.87 degrees about z, rounded as writers of MetaImage round it.
  const std::string path = write_headed(
      scratch, "a.mha",
      header("ElementSpacing = 0.7 0.7 -2\nOffset = 1 2 3\nTransformMatrix = 0.8 0.6 0 -0.6 0.79999 0 0 0 1\n"),
      stored(ramp()));
  EXPECT_EQ(open_source(path, {})->info().spacing, (std::array<double, 3>{0.7, 0.7, 2}));
  EXPECT_EQ(open_source(path, {})->info().origin, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(list_meta_image(path, {}).at(0).attributes.back().second,
            "axes oblique to the file's world, ignored: spacing is the length of a step");
}

TEST(MetaImageSource, ReadsValuesOfAnotherFile) {
  const Scratch scratch;
  std::filesystem::create_directories(scratch.path("headers"));
  write_headed(scratch, "a.raw", "head", stored(ramp()));
  for (const std::string size : {"4", "-1"}) {
    const std::string path = write_headed(scratch, "headers/a.mhd", header("HeaderSize = " + size + "\n", "../a.raw"));
    EXPECT_EQ(read_volume(*open_source(path, {})), as_floats(ramp())) << size;
  }
  write_headed(scratch, "a.zraw", "", deflated(stored(ramp()), Wrapper::zlib));
  std::string path = write_headed(scratch, "a.mhd", header("CompressedData = True\n", "a.zraw"));
  EXPECT_EQ(read_volume(*open_source(path, {})), as_floats(ramp()));
  path = write_headed(scratch, "b.mhd", header("", "none.raw"));
  EXPECT_EQ(refusal(path), path + ": its data file " + scratch.path("none.raw") +
                               ": cannot open for reading: No such file or directory");
}

TEST(MetaImageSource, IndexChoosesATimeStep) {
  const Scratch scratch;
  const std::string path = write_headed(
      scratch, "a.mha",
      "NDims = 4\nDimSize = 4 1 3 2\nElementType = MET_UCHAR\nElementSpacing = 1 2 3 0.1\nOffset = 4 5 6 7\n"
      "TransformMatrix = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\nElementDataFile = LOCAL\n",
      stored(ramp()));
  SourceOptions options;
  options.index = {1};
  const auto source = open_source(path, options);
  EXPECT_EQ(read_volume(*source), (std::vector<float>{12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23}));
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(source->info().origin, (std::array<double, 3>{4, 5, 6}));
}

// PLUS and SlicerIGT describe each frame of a sequence with several header lines.
TEST(MetaImageSource, SequenceOfManyFrames_HasALongHeader) {
  const Scratch scratch;
  const auto with_frames = [&](int frames, const std::string& key) {
    std::string lines;
    for (int i = 0; i < frames; ++i) {
      lines += cat(key, i, "_ProbeToTrackerTransform = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
    }
    return header(lines);
  };
  for (const int frames : {1, 20'000, 200'000}) {  // the longest header has 14 MiB of lines
    const std::string path = write_headed(scratch, "a.mha", with_frames(frames, "Seq_Frame"), stored(ramp()));
    EXPECT_EQ(read_volume(*open_source(path, {})), as_floats(ramp())) << frames;
  }
  const std::string path = write_headed(scratch, "b.mha", with_frames(20'000, "Other"), stored(ramp()));
  EXPECT_EQ(refusal(path), path + ": its header does not end within 1048576 bytes");
}

TEST(MetaImageSource, AFileCutAtAnyByteIsRefused) {
  const Scratch scratch;
  for (const bool compressed : {false, true}) {
    const auto bytes = compressed ? deflated(stored(ramp()), Wrapper::zlib) : stored(ramp());
    const std::string whole = header(compressed ? "CompressedData = True\n" : "") +
                              std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (std::size_t size = 1; size < whole.size(); ++size) {
      EXPECT_FALSE(refusal(write_headed(scratch, "cut.mha", whole.substr(0, size))).empty()) << size;
    }
    // A plain file may have extra bytes behind its values, but not as many as a second volume.
    const std::size_t more = compressed ? 1 : 24;
    EXPECT_FALSE(refusal(write_headed(scratch, "long.mha", whole + std::string(more, 'x'))).empty());
  }
}

TEST(MetaImageSource, LineEndBehindTheValues_IsSaid) {
  const Scratch scratch;
  auto values = stored(ramp());
  values.push_back(std::byte{'\n'});
  const std::size_t begin = header("").size();
  const auto source = open_source(write_headed(scratch, "a.mha", header(""), values), {});
  EXPECT_EQ(read_volume(*source), as_floats(ramp()));
  EXPECT_EQ(source->info().details.data_note,
            cat("the file has ", begin + 25, " bytes, and 24 of them, from byte ", begin,
                " on, are what the header describes; where the values begin elsewhere, correct HeaderSize"));
}

TEST(MetaImageSource, GarbageAndBombsAreRefused) {
  const Scratch scratch;
  std::string path = write_headed(scratch, "a.MHD",
                                  "\x7F"
                                  "ELF garbage\n");
  EXPECT_EQ(refusal(path), path + ": line 1 of its header is '?ELF garbage', not 'Key = Value'");
  path = write_headed(scratch, "bomb.mha", header("CompressedData = True\n"),
                      deflated(std::vector<std::byte>(std::size_t{32} << 20U), Wrapper::zlib));
  EXPECT_EQ(refusal(path), path + ": unpacks to more than the 24 bytes its header asks for; one of the two is damaged");
  path = write_headed(scratch, "offset.mha", header("HeaderSize = 9223372036854775807\n"), stored(ramp()));
  EXPECT_TRUE(refusal(path).starts_with(path + ": has 0 bytes from offset 9223372036854775807 on")) << refusal(path);
}

}  // namespace
}  // namespace weir::meta_image_source_test
