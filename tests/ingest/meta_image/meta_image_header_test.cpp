#include "ingest/meta_image/meta_image_header.h"

#include "ingest/headers/header_text.h"
#include "tests/ingest/support/scratch.h"

namespace weir::meta_image_header_test {
namespace {

const std::string kMinimal =
    "NDims = 3\n"
    "DimSize = 4 3 2\n"
    "ElementType = MET_UCHAR\n";

MetaImageHeader parse(const std::string& text) { return parse_meta_image_header(text, true, "a.mha"); }

std::string refusal(const std::string& text, bool whole = true) {
  return message_of_error(ErrorKind::input, [&] { parse_meta_image_header(text, whole, "a.mha"); });
}

std::string with(const std::string& entries, const std::string& data_file = "LOCAL") {
  return kMinimal + entries + "ElementDataFile = " + data_file + "\n";
}

TEST(MetaImageHeader, ParsesAMinimalHeader) {
  const MetaImageHeader header = parse(with("") + "\x01\x02");
  EXPECT_EQ(header.header_bytes, with("").size());
  EXPECT_EQ(header.type, ScalarType::uint8);
  EXPECT_EQ(header.dim_size, (std::vector<std::int64_t>{4, 3, 2}));
  EXPECT_FALSE(header.big_endian);
  EXPECT_FALSE(header.compressed);
  EXPECT_EQ(header.data_file, "");
  EXPECT_TRUE(header.spacing.empty());
  EXPECT_EQ(header.slope, 1);
}

TEST(MetaImageHeader, ParsesEveryFieldThatIsUsed) {
  const MetaImageHeader header = parse(
      "ObjectType = Image\r\nNDims = 3\r\nBinaryData = True\r\nBinaryDataByteOrderMSB = True\r\n"
      "CompressedData = True\r\nCompressedDataSize = 77\r\nTransformMatrix = 1 0 0 0 -1 0 0 0 1\r\n"
      "Offset = -1 2.5 3\r\nCenterOfRotation = 0 0 0\r\nAnatomicalOrientation = RAI\r\n"
      "ElementSpacing = 0.5 0.25 2\r\nElementSize = 9 9 9\r\nDimSize = 4 3 2\r\nHeaderSize = 12\r\n"
      "ElementNumberOfChannels = 1\r\nElementToIntensityFunctionSlope = 2\r\n"
      "ElementToIntensityFunctionOffset = -1024\r\nElementType = MET_SHORT\r\n"
      "ElementDataFile = a b.zraw\r\n");
  EXPECT_TRUE(header.big_endian);
  EXPECT_TRUE(header.compressed);
  EXPECT_EQ(header.compressed_bytes, 77);
  EXPECT_EQ(header.transform, (std::vector<double>{1, 0, 0, 0, -1, 0, 0, 0, 1}));
  EXPECT_EQ(header.origin, (std::vector<double>{-1, 2.5, 3}));
  EXPECT_EQ(header.spacing, (std::vector<double>{0.5, 0.25, 2}));
  EXPECT_EQ(header.header_size, 12);
  EXPECT_EQ(header.slope, 2);
  EXPECT_EQ(header.offset, -1024);
  EXPECT_EQ(header.type, ScalarType::int16);
  EXPECT_EQ(header.data_file, "a b.zraw");
}

TEST(MetaImageHeader, AcceptsAlternativeKeyNames) {
  EXPECT_EQ(parse(with("ElementSize = 1 2 3\n")).spacing, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(parse(with("Origin = 1 2 3\n")).origin, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(parse(with("Position = 1 2 3\n")).origin, (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(parse(with("ElementByteOrderMSB = 1\n")).big_endian);
  EXPECT_FALSE(parse(with("ElementByteOrderMSB = False\n")).big_endian);
  EXPECT_TRUE(parse(with("HeaderSize = -1\n")).at_end);
  EXPECT_EQ(parse(with("", "Local")).data_file, "");
}

TEST(MetaImageHeader, DataFileLineNeedsNoLineEnd) {
  EXPECT_EQ(parse(kMinimal + "ElementDataFile = a.raw").data_file, "a.raw");
  EXPECT_EQ(parse(kMinimal + "ElementDataFile = a.raw").header_bytes, kMinimal.size() + 23);
}

TEST(MetaImageHeader, RefusesInvalidHeaders) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "its header has no ElementDataFile, with which it must end; the file is cut"},
      {kMinimal, "its header has no ElementDataFile, with which it must end; the file is cut"},
      {"just text\n", "line 1 of its header is 'just text', not 'Key = Value'"},
      {"ElementDataFile = LOCAL\n", "its header has no ElementType"},
      {"ElementType = MET_FLOAT\nElementDataFile = LOCAL\n", "its header has no NDims"},
      {"ElementType = MET_FLOAT\nNDims = 3\nElementDataFile = LOCAL\n", "its header has no DimSize"},
      {"ElementType = MET_FLOAT\nNDims = 0\nElementDataFile = LOCAL\n", "line 2: NDims is '0'; it must be 1 to 10"},
      {"ElementType = MET_FLOAT\nNDims = x\nElementDataFile = LOCAL\n",
       "line 2: NDims is 'x'; a whole number belongs there"},
      {"ElementType = MET_FLOAT\nNDims = 3\nDimSize = 4 3\nElementDataFile = LOCAL\n",
       "line 3: DimSize is '4 3'; 3 whole numbers belong there"},
      {"ElementType = MET_FLOAT_ARRAY\nElementDataFile = LOCAL\n",
       "line 1: ElementType is 'MET_FLOAT_ARRAY'; MET_CHAR to MET_DOUBLE can be read, one value a voxel"},
      {with("NDims = 3\n"), "line 4 of its header gives 'NDims' a second time"},
      {with("ObjectType = Mesh\n"), "line 4: ObjectType is 'Mesh'; only Image can be read"},
      {with("ElementNumberOfChannels = 3\n"),
       "line 4: ElementNumberOfChannels is '3'; one value a voxel can be read; write each channel to a file"},
      {with("BinaryData = False\n"),
       "line 4: BinaryData is 'False'; values as text cannot be read; write the image with BinaryData = True"},
      {with("ElementSpacing = 1 2\n"), "line 4: ElementSpacing is '1 2'; 3 numbers belong there"},
      {with("TransformMatrix = 1 0 0\n"), "line 4: TransformMatrix is '1 0 0'; 9 numbers belong there"},
      {with("CompressedDataSize = -5\n"), "line 4: CompressedDataSize is '-5'; it must be 0 or more"},
      {with("HeaderSize = -2\n"),
       "line 4: HeaderSize is '-2'; it must be 0 or more, or -1 for uncompressed values at the file's end"},
      {with("CompressedData = True\nHeaderSize = -1\n"),
       "line 5: HeaderSize is '-1'; it must be 0 or more, or -1 for uncompressed values at the file's end"},
      {with("ElementToIntensityFunctionSlope = 0\n"),
       "line 4: ElementToIntensityFunctionSlope is '0'; it must not be 0"},
      {with("ElementToIntensityFunctionOffset = nan\n"),
       "line 4: ElementToIntensityFunctionOffset is 'nan'; a number belongs there"},
      {with("", ""), "line 4: ElementDataFile is ''; LOCAL or a file name belongs there"},
      {with("", "LIST"),
       "line 4: ElementDataFile is 'LIST'; one file for all values can be read; stack the files of a "
       "list with --stack"},
      {with("", "a_%03d.raw 1 10 1"),
       "line 4: ElementDataFile is 'a_%03d.raw 1 10 1'; one file for all values can be "
       "read; stack the files of a list with --stack"}};
  for (const auto& [text, message] : cases) EXPECT_EQ(refusal(text), "a.mha: " + message) << text;
}

TEST(MetaImageHeader, HeaderBeyondTheSizeLimitIsRefused) {
  const std::string comment = "Comment = ";
  EXPECT_EQ(refusal(comment + std::string(kHeaderLimit - comment.size(), 'x'), false),
            "a.mha: its header does not end within 1048576 bytes");
}

TEST(MetaImageHeader, CutAtAnyByteItIsRefused) {
  const std::string text = with("ElementSpacing = 1 1 1\n", "x");
  for (std::size_t size = 0; size + 2 < text.size(); ++size)
    EXPECT_FALSE(refusal(text.substr(0, size)).empty()) << size;
}

}  // namespace
}  // namespace weir::meta_image_header_test
