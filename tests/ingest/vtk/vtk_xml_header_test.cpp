#include "ingest/vtk/vtk_xml_header.h"

#include "tests/ingest/vtk/vtk_xml_file.h"

namespace weir::vtk_xml_header_test {
namespace {

VtkXmlHeader parse(const std::string& text) {
  VtkXmlSkeleton skeleton("a.vti");
  skeleton.push(text);
  return parse_vtk_xml_header(skeleton, "a.vti");
}

std::string refusal(const std::string& text) {
  return message_of_error(ErrorKind::input, [&] { parse(text); });
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

const std::string kArray = point_array("type=\"Float32\" Name=\"a\" format=\"ascii\"", "1 2 3");
const std::string kWhole = vti({}, kArray);

TEST(VtkXmlSkeleton, KeepsTagsAndTellsWhereTextLies) {
  const std::string text = "<?xml?><a x='>\"' y=\"<\">\n <b/> <!-- <c> -- --> \n1 2<d>  </d></a>";
  VtkXmlSkeleton whole("a.vti");
  EXPECT_TRUE(whole.push(text));
  EXPECT_EQ(whole.xml(), "<?xml?><a x='>\"' y=\"<\"><b/>45 50<d></d></a>");
  EXPECT_EQ(text.substr(45, 5), " \n1 2");
  // The result is the same if the bytes come one by one.
  VtkXmlSkeleton parts("a.vti");
  for (const char c : text) parts.push({&c, 1});
  EXPECT_EQ(parts.xml(), whole.xml());
}

TEST(VtkXmlSkeleton, EndsAtTheAppendedData) {
  using namespace std::string_literals;
  const std::string text = "<VTKFile><AppendedData encoding=\"raw\">\n \t_<\0>\""s;
  VtkXmlSkeleton skeleton("a.vti");
  EXPECT_FALSE(skeleton.push(text));
  EXPECT_EQ(skeleton.appended(), text.find('_') + 1);
  EXPECT_EQ(skeleton.xml(), "<VTKFile><AppendedData encoding=\"raw\"></AppendedData></VTKFile>");
}

TEST(VtkXmlSkeleton, HasLimits) {
  const auto refuse = [](const std::string& text) {
    return message_of_error(ErrorKind::input, [&] { VtkXmlSkeleton("a.vti").push(text); });
  };
  EXPECT_EQ(refuse("<!DOCTYPE a>"), "a.vti: at byte 3: a declaration begins; this is no VTK image file");
  std::string deep;
  for (int i = 0; i < 65; ++i) deep += "<a>";
  EXPECT_EQ(refuse(deep), "a.vti: at byte 194: its elements are nested deeper than 64; this is no VTK image file");
  EXPECT_EQ(refuse("<a x='" + std::string(2 << 20, 'y')),
            "a.vti: at byte 1048576: its markup is longer than 1048576 bytes; this is no VTK image file");
  EXPECT_EQ(refuse("<AppendedData>x"),
            "a.vti: at byte 14: appended data begin with another character than '_'; this is no VTK image file");
}

TEST(VtkXmlHeader, ParsesPlacementAndStorage) {
  const VtkXmlHeader header =
      parse(vti({true, true, 1}, kArray, "", " Origin=\"1 2 3\" Spacing=\"4 5 6\" Direction=\"0 1 0 1 0 0 0 0 1\""));
  EXPECT_TRUE(header.big_endian);
  EXPECT_EQ(header.word_bytes, 8U);
  EXPECT_TRUE(header.zlib);
  EXPECT_FALSE(header.appended.has_value());
  EXPECT_EQ(header.image.points, (Index3{4, 3, 2}));
  EXPECT_EQ(header.image.origin, (Vector3{1, 2, 3}));
  EXPECT_EQ(header.image.spacing, (Vector3{4, 5, 6}));
  EXPECT_EQ(header.image.direction[1], 1);
  ASSERT_EQ(header.arrays.size(), 1U);
  EXPECT_EQ(header.arrays[0].end - header.arrays[0].begin, 5U);
}

TEST(VtkXmlHeader, RefusesUnsupportedFiles) {
  EXPECT_EQ(refusal(replaced(kWhole, "\"ImageData\"", "\"PImageData\"")),
            "a.vti: type of VTKFile is 'PImageData'; write its pieces as one .vti file, or name one of them");
  EXPECT_EQ(refusal(replaced(kWhole, "\"ImageData\"", "\"RectilinearGrid\"")),
            "a.vti: type of VTKFile is 'RectilinearGrid'; ImageData can be read; resample other grids to an image");
  EXPECT_EQ(refusal(replaced(kWhole, "LittleEndian\"", "LittleEndian\" compressor=\"vtkLZ4DataCompressor\"")),
            "a.vti: compressor of VTKFile is 'vtkLZ4DataCompressor'; vtkZLibDataCompressor can be read; write the file "
            "with it or without compression");
  EXPECT_EQ(refusal(replaced(kWhole, "</Piece>", "</Piece><Piece/>")),
            "a.vti: holds 2 pieces, and one can be read; write the image as a whole");
  EXPECT_EQ(refusal(replaced(kWhole, "Piece Extent=\"0 3", "Piece Extent=\"0 2")),
            "a.vti: Extent of Piece is '0 2 0 2 0 1'; the image's WholeExtent is '0 3 0 2 0 1', and one piece with all "
            "of it can be read");
  EXPECT_EQ(refusal(replaced(kWhole, "LittleEndian", "Middle")),
            "a.vti: byte_order of VTKFile is 'Middle'; LittleEndian or BigEndian");
  EXPECT_EQ(refusal(replaced(kWhole, "WholeExtent=\"0 3 0 2 0 1\"", "WholeExtent=\"0 3 0 2 0 99999999999\"")),
            "a.vti: WholeExtent of ImageData is '0 3 0 2 0 99999999999'; six whole numbers of 32 bits belong there, "
            "first and last index along x, y, z");
  EXPECT_EQ(refusal(replaced(kWhole, "WholeExtent=\"0 3", "WholeExtent=\"0 -1")),
            "a.vti: WholeExtent of ImageData is '0 -1 0 2 0 1'; the image has no point");
  EXPECT_EQ(refusal("<a/>"), "a.vti: its XML has no VTKFile; this is no VTK image file");
  EXPECT_EQ(refusal(kWhole.substr(0, kWhole.size() / 2)),
            "a.vti: its XML cannot be read (Start-end tags mismatch); is the file complete?");
  EXPECT_EQ(refusal(replaced(kWhole, "\"ascii\"", "\"appended\" offset=\"0\"")),
            "a.vti: format of DataArray is 'appended'; and the file has no appended data; is it complete?");
  EXPECT_EQ(refusal(replaced(kWhole, "Extent=\"0 3", "Extnt=\"0 3")).substr(0, 45),
            "a.vti: WholeExtent of ImageData is missing; s");
}

TEST(VtkXmlHeader, ArraysThatAreNotReadSayWhy) {
  EXPECT_EQ(parse(replaced(kWhole, "Float32", "String")).arrays.at(0).obstacle,
            "its type is 'String', and Int8 to Float64 can be read");
  EXPECT_EQ(parse(replaced(kWhole, "Float32\"", "Float32\" NumberOfComponents=\"x\"")).arrays.at(0).obstacle,
            "its NumberOfComponents is no whole number");
  EXPECT_EQ(parse(replaced(kWhole, "1 2 3", " ")).arrays.at(0).obstacle, "it holds no data");
}

}  // namespace
}  // namespace weir::vtk_xml_header_test
