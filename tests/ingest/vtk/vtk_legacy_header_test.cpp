#include "ingest/vtk/vtk_legacy_header.h"

#include <sstream>

#include "tests/ingest/support/scratch.h"

namespace weir::vtk_legacy_header_test {
namespace {

VtkLegacyHeader parse(const std::string& text) {
  std::istringstream in(text);
  return parse_vtk_legacy_header(in, text.size(), "a.vtk");
}

std::string refusal(const std::string& text) {
  return message_of_error(ErrorKind::input, [&] { parse(text); });
}

const std::string kHead = "# vtk DataFile Version 2.0\ntitle\nBINARY\nDATASET STRUCTURED_POINTS\n";
const std::string kImage = kHead + "DIMENSIONS 2 2 1\nPOINT_DATA 4\n";

TEST(VtkLegacyHeader, ParsesPlacementAndArrays) {
  const VtkLegacyHeader header = parse(kHead +
                                       "DIMENSIONS 2 2 1\nSPACING 1 2 3\nORIGIN 4 5 6\nPOINT_DATA 4\n"
                                       "SCALARS a unsigned_char 1\nLOOKUP_TABLE default\nabcd\n"
                                       "CELL_DATA 1\nSCALARS a char\nlookup_table default\ne");
  EXPECT_TRUE(header.binary);
  EXPECT_EQ(header.image.points, (Index3{2, 2, 1}));
  EXPECT_EQ(header.image.spacing, (Vector3{1, 2, 3}));
  EXPECT_EQ(header.image.origin, (Vector3{4, 5, 6}));
  ASSERT_EQ(header.arrays.size(), 2U);
  EXPECT_EQ(header.arrays[0].name, "PointData/a");
  EXPECT_EQ(header.arrays[0].type, ScalarType::uint8);
  EXPECT_EQ(header.arrays[0].offset, kHead.size() + 17 + 14 + 13 + 13 + 26 + 21);
  EXPECT_EQ(header.arrays[1].name, "CellData/a");
  EXPECT_EQ(header.arrays[1].type, ScalarType::int8);
}

TEST(VtkLegacyHeader, TimeValue_IsReadFromTheFieldData) {
  const std::string image = "DIMENSIONS 2 2 1\nPOINT_DATA 4\n";
  const auto field = [](const std::string& array, const std::string& values) {
    return "FIELD FieldData 2\nCYCLE 1 1 int\n" + std::string(4, '\0') + "\n" + array + "\n" + values + "\n";
  };
  const std::string half("\x3F\xE0\0\0\0\0\0\0", 8);  // 0.5
  EXPECT_EQ(parse(kHead + field("TimeValue 1 1 double", half) + image).time, 0.5);
  EXPECT_EQ(parse(kHead + field("TimeValue 1 1 int", std::string("\0\0\0\7", 4)) + image).time, 7);
  EXPECT_EQ(parse(kHead + field("TimeValue 1 2 double", half + half) + image).time, std::nullopt);
  EXPECT_EQ(parse(kHead + field("timevalue 1 1 double", half) + image).time, std::nullopt);
  EXPECT_EQ(parse(kHead + field("TimeValue 1 1 double", std::string("\x7F\xF0\0\0\0\0\0\0", 8)) + image).time,
            std::nullopt)
      << "infinity is no time";
  EXPECT_EQ(refusal(kHead + "FIELD FieldData 1\nTimeValue 1 1 double\n" + half.substr(0, 5)),
            "a.vtk: before byte 105: 8 bytes of values belong behind it, and the file ends after 5; is it complete?");

  const std::string text = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET STRUCTURED_POINTS\n";
  EXPECT_EQ(parse(text + "FIELD FieldData 1\nTimeValue 1 1 double\n 1.25e-3 \n" + image).time, 1.25e-3);
  EXPECT_EQ(parse(text + "FIELD FieldData 1\nTimeValue 1 1 double\nearly\n" + image).time, std::nullopt);
  EXPECT_EQ(refusal(text + "FIELD FieldData 1\nTimeValue 1 1 double\n"),
            "a.vtk: before byte 104: a value belongs before it, and there is none; is the file complete?");
}

const std::string kHalf("\x3F\xE0\0\0\0\0\0\0", 8);  // 0.5
const std::string kText = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET STRUCTURED_POINTS\n";

/// Returns a string as vtkDataWriter writes it: its length in the fewest bytes, then its text.
std::string binary_string(const std::string& value) {
  const std::size_t n = value.size();
  const auto byte = [](std::size_t bits) { return static_cast<char>(bits & 0xFFU); };
  if (n < 64) return byte(3U << 6U | n) + value;
  return std::string{byte(2U << 6U | n >> 8U), byte(n)} + value;
}

TEST(VtkLegacyHeader, StringsOfTheFieldData_AreSkipped) {
  // Line ends and keywords in a string must not be taken for lines of the file.
  const std::string long_one = "a\nPOINT_DATA 9\n" + std::string(5000, 'x');
  const VtkLegacyHeader binary =
      parse(kHead + "FIELD FieldData 3\nDate 1 3 string\n" + binary_string("1 May\n") + binary_string("") +
            binary_string(long_one) + "\nNote 2 1 utf8_string\n" + std::string("\x40\0\0\2hi", 6) +
            std::string("\0\0\0\0\0\0\0\3abc", 11) + "\nTimeValue 1 1 double\n" + kHalf +
            "\nDIMENSIONS 2 2 1\nPOINT_DATA 4\nSCALARS a char\nLOOKUP_TABLE default\nabcd\n");
  EXPECT_EQ(binary.time, 0.5);
  ASSERT_EQ(binary.arrays.size(), 1U);
  EXPECT_EQ(binary.arrays[0].name, "a");
  // In a text file each string is a line, which may be empty.
  const VtkLegacyHeader text =
      parse(kText + "FIELD FieldData 3\nDate 1 3 string\n1%20May%0A\n\n" + std::string(5000, 'x') +
            "\nMETADATA\nINFORMATION 0\n\nNote 1 1 UTF8_STRING\na b c\nTimeValue 1 1 double\n0.5\n"
            "DIMENSIONS 2 2 1\nPOINT_DATA 4\nSCALARS a char\nLOOKUP_TABLE default\n1 2 3 4\n");
  EXPECT_EQ(text.time, 0.5);
  ASSERT_EQ(text.arrays.size(), 1U);
  EXPECT_EQ(text.arrays[0].name, "a");
}

TEST(VtkLegacyHeader, StringsOfPointsAndCells_AreObstacles) {
  const VtkLegacyHeader header =
      parse(kImage + "FIELD f 2\nnames 1 4 string\n" + binary_string("a") + binary_string("") + binary_string("b\n") +
            binary_string("c") + "\nv 1 4 char\nabcd\nCELL_DATA 1\nPEDIGREE_IDS ids string\n" + binary_string("d") +
            "\nSCALARS w char\nLOOKUP_TABLE default\ne");
  ASSERT_EQ(header.arrays.size(), 4U);
  EXPECT_EQ(header.arrays[0].name, "names");
  EXPECT_EQ(header.arrays[0].obstacle, "its type is 'string', and char to double can be read");
  EXPECT_EQ(header.arrays[1].name, "v");
  EXPECT_EQ(header.arrays[1].obstacle, "");
  EXPECT_EQ(header.arrays[2].name, "ids");
  EXPECT_TRUE(header.arrays[2].cells);
  EXPECT_EQ(header.arrays[2].obstacle, "its type is 'string', and char to double can be read");
  EXPECT_EQ(header.arrays[3].name, "w");
  EXPECT_EQ(header.arrays[3].obstacle, "");
}

TEST(VtkLegacyHeader, StringsBeyondTheFilesEnd_AreRefused) {
  const auto refuse = [](const std::string& head, const std::string& more) {
    const std::string message = refusal(head + "FIELD f 1\n" + more);
    return message.substr(message.find(": ", message.find("byte")) + 2);
  };
  EXPECT_EQ(refuse(kHead, "s 1 1 string\n\x3F" + std::string(7, '\xFF')),
            "4611686018427387903 bytes of values belong behind it, and the file ends after 0; is it complete?");
  EXPECT_EQ(refuse(kHead,
                   "s 1 1 string\n\xC5"
                   "abcd"),
            "5 bytes of values belong behind it, and the file ends after 4; is it complete?");
  EXPECT_EQ(refuse(kHead, std::string("s 1 1 string\n\x40\0", 15)),
            "3 bytes of values belong behind it, and the file ends after 1; is it complete?");
  EXPECT_EQ(refuse(kHead, "s 1 9223372036854775807 string\n\xC0\xC0"),
            "9223372036854775807 values belong before it, and there are 2; is the file complete?");
  EXPECT_EQ(refuse(kText, "s 1 9223372036854775807 string\na\n\nb"),
            "9223372036854775807 values belong before it, and there are 3; is the file complete?");
  EXPECT_EQ(refuse(kHead, "s 1024 9223372036854775807 string\n"),
            "'s 1024 9223372036854775807 string'; 9223372036854775807 tuples of 1024 values are impossible");
}

TEST(VtkLegacyHeader, RefusesUnsupportedFiles) {
  EXPECT_EQ(refusal("x"), "a.vtk: before byte 1: the file does not begin with '# vtk DataFile Version'");
  EXPECT_EQ(refusal("# vtk DataFile Version 2.0\n\nHEX\n"),
            "a.vtk: before byte 32: 'hex'; BINARY or ASCII belongs there");
  EXPECT_EQ(refusal("# vtk DataFile Version 2.0\n\nASCII\nDATASET POLYDATA\n"),
            "a.vtk: before byte 51: 'dataset POLYDATA'; STRUCTURED_POINTS can be read; resample other data sets to it");
  EXPECT_EQ(refusal(kHead + "COLOUR 1\n"),
            "a.vtk: before byte 75: 'colour 1'; DIMENSIONS, SPACING, ORIGIN or POINT_DATA belongs there");
  EXPECT_EQ(refusal(kHead),
            "a.vtk: before byte 66: the file has no DIMENSIONS before its values; it is cut or damaged");
}

TEST(VtkLegacyHeader, RefusesInconsistentHeaders) {
  const auto refuse = [](const std::string& more) {
    const std::string message = refusal(kImage + more);
    return message.substr(message.find(": ", message.find("byte")) + 2);
  };
  EXPECT_EQ(refusal(kHead + "DIMENSIONS 2 2 1\nPOINT_DATA 5\n"),
            "a.vtk: before byte 96: 'point_data 5'; DIMENSIONS make 4");
  EXPECT_EQ(refuse("SCALARS a float\nLOOKUP_TABLE default\n0123456789"),
            "16 bytes of values belong behind it, and the file ends after 10; is it complete?");
  EXPECT_EQ(refuse("SCALARS a float\nabcd"), "'abcd'; LOOKUP_TABLE belongs behind SCALARS");
  EXPECT_EQ(refuse("SCALARS a variant\nLOOKUP_TABLE default\n"),
            "'lookup_table default'; the type 'variant' is not known, nor how long its values are");
  EXPECT_EQ(refuse("LOOKUP_TABLE l 9223372036854775807\n"),
            "'lookup_table l 9223372036854775807'; 9223372036854775807 tuples of 4 values are impossible");
  EXPECT_EQ(refuse("FIELD f 1\na 1 5 float\n"), "'a 1 5 float'; DIMENSIONS make 4 tuples");
  EXPECT_EQ(refuse("FIELD f 2\n"), "'field f 2'; the field has 2 arrays; the file is cut");
  EXPECT_EQ(refuse("SCALARS a float -1\nLOOKUP_TABLE"), "'scalars a float -1'; a count belongs at word 4");
  EXPECT_EQ(refuse(std::string(5000, 'x')), "a line is longer than 4096 bytes");
  EXPECT_EQ(refusal(kHead + "DIMENSIONS 4000000000 1 1\n"),
            "a.vtk: extent 4000000000x1x1 has 4000000000 voxels along x; each axis must be 1 to 2147483647");
}

}  // namespace
}  // namespace weir::vtk_legacy_header_test
