#include "ingest/nrrd/nrrd_header.h"

#include <cmath>

#include "ingest/headers/header_text.h"
#include "tests/ingest/support/scratch.h"

namespace weir::nrrd_header_test {
namespace {

const std::string kMinimal =
    "NRRD0001\n"
    "type: uint8\n"
    "dimension: 3\n"
    "sizes: 4 3 2\n"
    "encoding: raw\n";

NrrdHeader parse(const std::string& text) { return parse_nrrd_header(text, true, "a.nrrd"); }

std::string refusal(const std::string& text, bool whole = true) {
  return message_of_error(ErrorKind::input, [&] { parse_nrrd_header(text, whole, "a.nrrd"); });
}

std::string with(const std::string& field) { return kMinimal + field + "\n\n"; }

/// Returns `text` with the line that begins with `name` replaced by `line`, or removed if `line` is empty.
std::string replaced(std::string text, const std::string& name, const std::string& line) {
  const std::size_t start = text.find(name);
  text.replace(start, text.find('\n', start) + 1 - start, line.empty() ? "" : line + "\n");
  return text;
}

TEST(NrrdHeader, ParsesAMinimalHeader) {
  const NrrdHeader header = parse(kMinimal + "\n\x01\x02");
  EXPECT_EQ(header.header_bytes, kMinimal.size() + 1);
  EXPECT_EQ(header.type, ScalarType::uint8);
  EXPECT_EQ(header.sizes, (std::vector<std::int64_t>{4, 3, 2}));
  EXPECT_FALSE(header.gzip);
  EXPECT_FALSE(header.big_endian);
  EXPECT_FALSE(header.at_end);
  EXPECT_EQ(header.data_file, "");
  EXPECT_TRUE(header.spacings.empty());
  EXPECT_TRUE(header.directions.empty());
}

TEST(NrrdHeader, ParsesThePlacementFields) {
  const std::string text =
      "NRRD0005\r\n"
      "# made by hand\r\n"
      "type: unsigned short int\r\n"
      "dimension: 4\r\n"
      "space: left-posterior-superior\r\n"
      "sizes: 1 4 3 2\r\n"
      "space directions: none (0.5,0,0) (0, 0.25 ,0) (0,0,-2e0)\r\n"
      "kinds: Scalar domain domain domain\r\n"
      "labels: \"\" \"left\" \"a \\\"b\\\"\" \"up\"\r\n"
      "endian: BIG\r\n"
      "Encoding: GZ\r\n"
      "space origin: (-1,2.5,3)\r\n"
      "sample units: HU\r\n"
      "lineskip: 2\r\n"
      "byte skip: 16\r\n"
      "DWMRI_b-value:=1000\r\n"
      "data file: sub/values.raw.gz\r\n"
      "\r\n";
  const NrrdHeader header = parse(text + "rest");
  EXPECT_EQ(header.header_bytes, text.size());
  EXPECT_EQ(header.type, ScalarType::uint16);
  EXPECT_TRUE(header.big_endian);
  EXPECT_TRUE(header.gzip);
  EXPECT_EQ(header.kinds, (std::vector<std::string>{"scalar", "domain", "domain", "domain"}));
  EXPECT_EQ(header.labels, (std::vector<std::string>{"", "left", "a \"b\"", "up"}));
  ASSERT_EQ(header.directions.size(), 4);
  EXPECT_EQ(header.directions[0], std::nullopt);
  EXPECT_EQ(header.directions[2], (std::vector<double>{0, 0.25, 0}));
  EXPECT_EQ(header.directions[3], (std::vector<double>{0, 0, -2}));
  EXPECT_EQ(header.space_origin, (std::vector<double>{-1, 2.5, 3}));
  EXPECT_EQ(header.sample_units, "HU");
  EXPECT_EQ(header.line_skip, 2);
  EXPECT_EQ(header.byte_skip, 16);
  EXPECT_EQ(header.data_file, "sub/values.raw.gz");
}

TEST(NrrdHeader, ParsesFieldsOfTheAxes) {
  const NrrdHeader header =
      parse(with("spacings: nan 0.5 2\naxis mins: 0 nan -1\naxismaxs: 4 nan 1\ncenters: cell ??? node"));
  EXPECT_TRUE(std::isnan(header.spacings[0]));
  EXPECT_EQ(header.spacings[2], 2);
  EXPECT_EQ(header.axis_mins[2], -1);
  EXPECT_EQ(header.axis_maxs[0], 4);
  EXPECT_EQ(header.centerings, (std::vector<std::string>{"cell", "???", "node"}));
}

TEST(NrrdHeader, KeysWithColons_AreNoFields) {
  const NrrdHeader header =
      parse(with("dicom:0008:=a\ndicom:0008:=b\nspacings:orig:=0.5\nsizes:=1\nsizes:=2\nnote:=see: below\n"
                 "spacings: 1 2 3"));
  EXPECT_EQ(header.spacings, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(header.sizes, (std::vector<std::int64_t>{4, 3, 2}));
  // A field ends at the first ": ", and its value may have ":=" in it.
  EXPECT_EQ(parse(with("sample units: m:=1")).sample_units, "m:=1");
  EXPECT_EQ(parse(with("sample units:m")).sample_units, "m") << "no blank, and no key";
  EXPECT_EQ(refusal(with("spacings: 1 1 1\nspacings: a:=b")),
            "a.nrrd: line 7 of its header gives 'spacings' a second time");
}

TEST(NrrdHeader, ParsesUnits) {
  EXPECT_EQ(parse(with("units: \"mm\" \"\" \"a \\\"b\\\"\"")).units, (std::vector<std::string>{"mm", "", "a \"b\""}));
  EXPECT_EQ(parse(with("space units: \"mm\" \"um\"")).space_units, (std::vector<std::string>{"mm", "um"}));
  for (const std::string other : {"units: \"mm\"", "units: \"mm\" \"mm\" \"mm", "units: mm mm mm"}) {
    EXPECT_TRUE(parse(with(other)).units.empty()) << other;
  }
}

TEST(NrrdHeader, AcceptsEveryTypeNameAndNoOther) {
  const std::vector<std::pair<ScalarType, std::vector<std::string>>> names{
      {ScalarType::int8, {"signed char", "int8", "int8_t"}},
      {ScalarType::uint8, {"uchar", "unsigned char", "uint8", "uint8_t"}},
      {ScalarType::int16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"}},
      {ScalarType::uint16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}},
      {ScalarType::int32, {"int", "signed int", "int32", "int32_t"}},
      {ScalarType::uint32, {"uint", "unsigned int", "uint32", "uint32_t"}},
      {ScalarType::int64, {"longlong", "long long", "long long int", "signed long long", "int64", "int64_t"}},
      {ScalarType::uint64, {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}},
      {ScalarType::float32, {"float"}},
      {ScalarType::float64, {"double"}}};
  for (const auto& [type, texts] : names) {
    for (const std::string& name : texts) {
      EXPECT_EQ(parse(replaced(with("endian: little"), "type", "type: " + name)).type, type) << name;
    }
  }
  for (const std::string name : {"block", "char", "", "int8 uint8"}) {
    EXPECT_EQ(refusal(replaced(with("endian: little"), "type", "type: " + name)),
              "a.nrrd: line 2: type is '" + name + "'; integers of 8 to 64 bits, float and double can be read");
  }
}

TEST(NrrdHeader, DetachedHeadersMayEndWithTheFile) {
  EXPECT_EQ(parse(kMinimal + "data file: a.raw").data_file, "a.raw");
  EXPECT_EQ(parse(kMinimal + "datafile: a b.raw\n\n").data_file, "a b.raw");
  EXPECT_EQ(refusal(kMinimal), "a.nrrd: its header has no field 'datafile'");
  EXPECT_EQ(refusal(kMinimal + "data file:"), "a.nrrd: line 6: datafile is ''; a file name belongs there");
}

TEST(NrrdHeader, RefusesListsOfFiles) {
  EXPECT_EQ(refusal(with("data file: LIST 2\na.raw\nb.raw")),
            "a.nrrd: line 6: datafile is 'LIST 2'; one file for all values can be read; stack the files of a list with "
            "--stack");
  EXPECT_EQ(refusal(with("data file: a_%03d.raw 1 10 1 2")),
            "a.nrrd: line 6: datafile is 'a_%03d.raw 1 10 1 2'; one file for all values can be read; stack the files "
            "of a list with --stack");
}

TEST(NrrdHeader, RefusesInvalidHeaders) {
  const std::string not_as_named = ": the file is of another format than its name says, or its beginning is lost";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "does not begin with NRRD000" + not_as_named},
      {"nrrd0001\n", "does not begin with NRRD000" + not_as_named},
      {"NRRD0006\n", "begins with 'NRRD0006'; versions NRRD0001 to NRRD0005 can be read"},
      {"NRRD00011\n", "begins with 'NRRD00011'; versions NRRD0001 to NRRD0005 can be read"},
      {"NRRD000", "begins with 'NRRD000'; versions NRRD0001 to NRRD0005 can be read"},
      {replaced(with(""), "type", ""), "its header has no field 'type'"},
      {replaced(with(""), "encoding", ""), "its header has no field 'encoding'"},
      {replaced(with(""), "dimension", ""), "its header has no field 'dimension'"},
      {replaced(with(""), "sizes", ""), "its header has no field 'sizes'"},
      {replaced(with(""), "type", "type: float"), "its header has no field 'endian'"},
      {replaced(with("endian: middle"), "type", "type: short"), "line 6: endian is 'middle'; it must be little or big"},
      {replaced(with(""), "dimension", "dimension: 0"), "line 3: dimension is '0'; it must be 1 to 16"},
      {replaced(with(""), "dimension", "dimension: 17"), "line 3: dimension is '17'; it must be 1 to 16"},
      {replaced(with(""), "sizes", "sizes: 4 3"), "line 4: sizes is '4 3'; 3 whole numbers belong there"},
      {replaced(with(""), "sizes", "sizes: 4 3 2.5"), "line 4: sizes is '4 3 2.5'; 3 whole numbers belong there"},
      {replaced(with(""), "sizes", "sizes: 4 3 99999999999999999999"),
       "line 4: sizes is '4 3 99999999999999999999'; 3 whole numbers belong there"},
      {replaced(with(""), "encoding", "encoding: ascii"),
       "line 5: encoding is 'ascii'; raw and gzip can be read; convert it with `unu save -f nrrd -e gzip`"},
      {replaced(with(""), "encoding", "encoding: bzip2"),
       "line 5: encoding is 'bzip2'; raw and gzip can be read; convert it with `unu save -f nrrd -e gzip`"},
      {with("type: int8"), "line 6 of its header gives 'type' a second time"},
      {with("no field"), "line 6 of its header is 'no field', neither a field nor a comment"},
      {with("spacings: 1 1"), "line 6: spacings is '1 1'; 3 numbers belong there"},
      {with("kinds: domain"), "line 6: kinds is 'domain'; 3 words belong there"},
      {with("space directions: (1,0,0) (0,1,0)"),
       "line 6: spacedirections is '(1,0,0) (0,1,0)'; 3 vectors such as (1,0,0), or none, belong there"},
      {with("space directions: (1,0,0) (0,1,0) (0,0,x)"),
       "line 6: spacedirections is '(1,0,0) (0,1,0) (0,0,x)'; 3 vectors such as (1,0,0), or none, belong there"},
      {with("space directions: (1,0,0) (0,1,0) (0,0"),
       "line 6: spacedirections is '(1,0,0) (0,1,0) (0,0'; 3 vectors such as (1,0,0), or none, belong there"},
      {with("space origin: 1,2,3"), "line 6: spaceorigin is '1,2,3'; one vector such as (0,0,0) belongs there"},
      {with("line skip: -1"), "line 6: lineskip is '-1'; it must be 0 or more"},
      {with("byte skip: -2"),
       "line 6: byteskip is '-2'; it must be 0 or more, or -1 for raw values at the file's end"}};
  for (const auto& [text, message] : cases) EXPECT_EQ(refusal(text), "a.nrrd: " + message) << text;
  EXPECT_EQ(refusal(replaced(with("byte skip: -1"), "encoding", "encoding: gzip")),
            "a.nrrd: line 6: byteskip is '-1'; it must be 0 or more, or -1 for raw values at the file's end");
}

TEST(NrrdHeader, HeaderBeyondTheSizeLimitIsRefused) {
  const std::string endless = "NRRD0001\n# " + std::string(kHeaderLimit, 'x');
  EXPECT_EQ(refusal(endless, false), "a.nrrd: its header does not end within 1048576 bytes");
  EXPECT_EQ(refusal(kMinimal, false), "a.nrrd: its header does not end within 1048576 bytes");
}

TEST(NrrdHeader, CutAtAnyByteItIsRefusedOrDetached) {
  const std::string text = with("data file: values.raw");
  for (std::size_t size = 0; size + 2 < text.size(); ++size) {
    try {
      EXPECT_FALSE(parse(text.substr(0, size)).data_file.empty()) << size;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
    }
  }
}

}  // namespace
}  // namespace weir::nrrd_header_test
