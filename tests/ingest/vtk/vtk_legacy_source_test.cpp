#include "ingest/vtk/vtk_legacy_source.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "ingest/source_registry.h"
#include "tests/ingest/support/header_file.h"

namespace weir::vtk_legacy_source_test {
namespace {

std::string head(const std::string& encoding, const std::string& more = "") {
  return "# vtk DataFile Version 3.0\na title\n" + encoding + "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 4 3 2\n" + more;
}

std::string chars(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string scalars(const std::string& name, const std::string& type, const std::string& values) {
  return "SCALARS " + name + " " + type + "\nLOOKUP_TABLE default\n" + values + "\n";
}

std::string ramp_text() {
  std::string text;
  for (int i = 0; i < 24; ++i) text += std::to_string(i) + (i % 9 == 8 ? "\n" : " ");
  return text;
}

std::vector<float> ramp() {
  std::vector<float> values(24);
  for (std::size_t i = 0; i < 24; ++i) values[i] = static_cast<float>(i);
  return values;
}

std::string refusal(const std::string& path, ErrorKind kind = ErrorKind::input) {
  return message_of_error(kind, [&] { open_source(path, {}); });
}

SourceOptions naming(const std::string& dataset) {
  SourceOptions options;
  options.dataset = dataset;
  return options;
}

template <typename T>
void expect_type(const std::string& type) {
  const Scratch scratch;
  const auto values = telling_values<T>(24);
  const std::string path = write_headed(
      scratch, "a.vtk", head("BINARY", "POINT_DATA 24\n") + scalars("a", type, chars(stored(values, true))));
  const auto source = open_source(path, {});
  EXPECT_EQ(source->info().format, "vtk-legacy");
  EXPECT_EQ(source->info().dataset, "a");
  EXPECT_EQ(source->info().extent, (Index3{4, 3, 2}));
  EXPECT_EQ(source->info().file_bytes, std::filesystem::file_size(path));
  EXPECT_EQ(read_volume(*source), as_floats(values)) << type;
}

TEST(VtkLegacySource, ReadsEveryType) {
  expect_type<std::int8_t>("char");
  expect_type<std::uint8_t>("unsigned_char");
  expect_type<std::int16_t>("short");
  expect_type<std::uint16_t>("unsigned_short");
  expect_type<std::int32_t>("int");
  expect_type<std::uint32_t>("unsigned_int");
  expect_type<std::int32_t>("vtkIdType");
  expect_type<std::int64_t>("long");
  expect_type<std::uint64_t>("unsigned_long");
  expect_type<std::int64_t>("vtktypeint64");
  expect_type<float>("float");
  expect_type<double>("double");
}

TEST(VtkLegacySource, ReadsTextAndPlace) {
  const Scratch scratch;
  const std::string path = write_headed(scratch, "a.vtk",
                                        head("ascii", "\nASPECT_RATIO 0.5 0.25 2\norigin 1 2 3\n\nPOINT_DATA 24\n") +
                                            scalars("a", "double 1", ramp_text()));
  const auto source = open_source(path, {});
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{0.5, 0.25, 2}));
  EXPECT_EQ(source->info().origin, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(read_volume(*source), ramp());
}

TEST(VtkLegacySource, CellsOfAFlatImage_LieInItsPlane) {
  const Scratch scratch;
  const std::string place =
      "# vtk DataFile Version 3.0\na\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 9 9 1\n"
      "ORIGIN 0 0 5\nSPACING 1 1 2\nCELL_DATA 64\n";
  const std::string path = write_headed(scratch, "a.vtk", place + scalars("a", "unsigned_char", std::string(64, '\3')));
  const SourceInfo info = open_source(path, {})->info();
  EXPECT_EQ(info.extent, (Index3{8, 8, 1}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{0.5, 0.5, 5}));
}

TEST(VtkLegacySource, FindsArraysAfterEveryOtherSection) {
  const Scratch scratch;
  const auto bytes = [](std::size_t count) {
    return std::string(count, '\n');
  };  // binary values that look like line ends
  const std::string values = chars(stored(telling_values<std::int16_t>(24), true));
  const std::string text =
      head("BINARY", "SPACING 1 1 1\r\nFIELD FieldData 2\nTIME 1 1 double\n" + bytes(8) +
                         "\nMETADATA\nINFORMATION 0\n\nnote 1 4 char\n" + bytes(4) + "\nPOINT_DATA 24\n") +
      "VECTORS v float\n" + bytes(24 * 12) + "\n" + "NORMALS n double\n" + bytes(24 * 24) + "\n" + "TENSORS t float\n" +
      bytes(24 * 36) + "\nTEXTURE_COORDINATES u 2 float\n" + bytes(24 * 8) + "\nCOLOR_SCALARS c 3\n" + bytes(72) +
      "\nLOOKUP_TABLE l 5\n" + bytes(20) + "\nSCALARS bits bit\nLOOKUP_TABLE l\n" + bytes(3) +
      "\nGLOBAL_IDS g vtkIdType\n" + bytes(96) + "\n" + scalars("first%20one", "short", values) +
      "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE\n\nFIELD FieldData 2\nwide 2 24 float\n" + bytes(192) +
      "\nIn_Field 1 24 short\n" + values + "\nCELL_DATA 6\n" + scalars("cells", "unsigned_char", "\1\2\3\4\5\6");
  const std::string path = write_headed(scratch, "a.vtk", text);
  const auto expected = as_floats(telling_values<std::int16_t>(24));
  EXPECT_EQ(read_volume(*open_source(path, naming("first one"))), expected);
  EXPECT_EQ(read_volume(*open_source(path, naming("In_Field"))), expected);
  const auto cells = open_source(path, naming("cells"));
  EXPECT_EQ(cells->info().extent, (Index3{3, 2, 1}));
  EXPECT_EQ(cells->info().origin, (std::array<double, 3>{0.5, 0.5, 0.5}));
  EXPECT_EQ(read_volume(*cells), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(refusal(path, ErrorKind::usage), path +
                                                 ": holds 4 arrays that can be converted; name an array with "
                                                 "--dataset: 'g', 'first one', 'In_Field', 'cells'");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, naming("bits")); }),
            path + ": array 'bits' cannot be converted: its type is 'bit', and char to double can be read");
}

// Voxel i has the vector (i, 2 i, -2 i). Its length is 3 i.
TEST(VtkLegacySource, ComponentOfVectorsIsTheVolume) {
  const Scratch scratch;
  std::vector<float> vectors;
  std::string text;
  for (int i = 0; i < 24; ++i) {
    for (const int factor : {1, 2, -2}) {
      vectors.push_back(static_cast<float>(factor * i));
      text += cat(factor * i, " ");
    }
  }
  const auto times = [](float factor) {
    std::vector<float> values = ramp();
    for (float& value : values) value *= factor;
    return values;
  };
  for (const std::string& file :
       {head("BINARY", "POINT_DATA 24\nVECTORS v float\n") + chars(stored(vectors, true)) + "\n",
        head("ASCII", "POINT_DATA 24\nVECTORS v float\n") + text + "\n" + scalars("s", "int", ramp_text())}) {
    const std::string path = write_headed(scratch, "a.vtk", file);
    for (const auto& [choice, factor] : {std::pair("x", 1.0F), std::pair("2", -2.0F), std::pair("magnitude", 3.0F)}) {
      SourceOptions options;
      options.component = parse_component(choice);
      const auto source = open_source(path, options);
      EXPECT_EQ(source->info().dataset, "v");
      EXPECT_EQ(source->info().details.component, component_text(*options.component));
      EXPECT_EQ(read_volume(*source), times(factor)) << choice;
    }
    EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, naming("v")); }),
              path + ": array 'v': has 3 components a voxel; give --component: 0 to 2, x, y, z or magnitude");
  }
}

// VTK writes scalars of unsigned char in this form (vtkDataWriter::WriteScalarData).
TEST(VtkLegacySource, ColorScalars_AreReadAsUint8) {
  const Scratch scratch;
  std::string bytes;
  std::string text;
  std::vector<float> expected;
  for (int i = 0; i < 24; ++i) {
    const int value = i * 11;  // 0 to 253
    bytes += static_cast<char>(value);
    text += cat(static_cast<float>(value) / 255.0F, ' ');
    expected.push_back(static_cast<float>(value));
  }
  for (const std::string& file : {head("BINARY", "POINT_DATA 24\nCOLOR_SCALARS c 1\n") + bytes + "\n",
                                  head("ASCII", "POINT_DATA 24\nCOLOR_SCALARS c 1\n") + text + "\n"}) {
    const std::string path = write_headed(scratch, "a.vtk", file);
    const auto source = open_source(path, {});
    EXPECT_EQ(source->info().dataset, "c");
    EXPECT_EQ(source->info().type, ScalarType::uint8);
    EXPECT_EQ(read_volume(*source), expected);
    const auto list = list_vtk_legacy(path, {});
    ASSERT_EQ(list.size(), 1U);
    EXPECT_EQ(list[0].type, "uint8");
    EXPECT_EQ(list[0].obstacle, "");
  }
  const std::string path = write_headed(scratch, "two.vtk",
                                        head("BINARY", "POINT_DATA 24\nCOLOR_SCALARS c 1\n") + bytes + "\n" +
                                            scalars("other", "float", std::string(96, '\0')));
  EXPECT_EQ(refusal(path, ErrorKind::usage),
            path + ": holds 2 arrays that can be converted; name an array with --dataset: 'c', 'other'");
}

// 0.25 means 63.75, 0.75 means 191.25, and 2e-3 means 0.51 (times 255). VTK rounds to the nearest integer.
TEST(VtkLegacySource, ColorScalarsOfSeveralComponents_TakeComponent) {
  const Scratch scratch;
  std::string text;
  for (int i = 0; i < 24; ++i) text += "0.25 0.75 2e-3\n";
  const std::string path = write_headed(scratch, "a.vtk", head("ASCII", "POINT_DATA 24\nCOLOR_SCALARS rgb 3\n") + text);
  for (const auto& [choice, value] : {std::pair("0", 64.0F), std::pair("1", 191.0F), std::pair("2", 1.0F)}) {
    SourceOptions options;
    options.component = parse_component(choice);
    EXPECT_EQ(read_volume(*open_source(path, options)), std::vector<float>(24, value)) << choice;
  }
  EXPECT_EQ(refusal(path, ErrorKind::usage),
            path + ": array 'rgb': has 3 components a voxel; give --component: 0 to 2, x, y, z or magnitude");
}

TEST(VtkLegacySource, ColorScalarsInTextBeyondOne_AreRefused) {
  const Scratch scratch;
  for (const char* const wrong : {"1.5", "-0.1", "nan", "red"}) {
    std::string text = "1 1 ";
    text += wrong;
    for (int i = 3; i < 24; ++i) text += " 0";
    const std::string path =
        write_headed(scratch, "a.vtk", head("ASCII", "POINT_DATA 24\nCOLOR_SCALARS c 1\n") + text + "\n");
    EXPECT_EQ(refusal(path), cat(path, ": array 'c': value 2 of its text is '", wrong,
                                 "', no number from 0 to 1, as COLOR_SCALARS in text have them; correct it"));
  }
}

TEST(VtkLegacySource, ArraysThatCannotBeRead_AreNamedBesideTheOneThatIsTaken) {
  const Scratch scratch;
  const std::string path = write_headed(
      scratch, "a.vtk",
      head("ASCII", "POINT_DATA 24\n") + scalars("mask", "bit", ramp_text()) + scalars("a", "float", ramp_text()));
  std::vector<std::string> said;
  SourceOptions options;
  options.notice = [&](const Message& line) { said.push_back(line.text()); };
  EXPECT_EQ(open_source(path, options)->info().dataset, "a");
  EXPECT_EQ(said, (std::vector<std::string>{
                      path + ": a is read; left out: mask: its type is 'bit', and char to double can be read"}));
  options.dataset = "a";
  open_source(path, options);
  EXPECT_EQ(said.size(), 1U) << "where it is named, nothing is said";
}

TEST(VtkLegacySource, FindsArraysBehindText) {
  const Scratch scratch;
  const std::string text = head("ASCII", "POINT_DATA 24\nVECTORS v float\n") + ramp_text() + ramp_text() + ramp_text() +
                           scalars("a", "int", ramp_text()) + scalars("b", "float", ramp_text());
  const std::string path = write_headed(scratch, "a.vtk", text);
  EXPECT_EQ(read_volume(*open_source(path, naming("a"))), ramp());
  EXPECT_EQ(read_volume(*open_source(path, naming("b"))), ramp());
  const auto list = list_vtk_legacy(path, {});
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].components, 3);
  EXPECT_EQ(list[0].obstacle, "");
  EXPECT_EQ(list[1].name, "a");
  EXPECT_EQ(list[1].type, "int32");
  EXPECT_EQ(list[1].layout, "text");
  EXPECT_EQ(list[1].extents, (std::vector<std::int64_t>{4, 3, 2}));
}

TEST(VtkLegacySource, WordsThatAreNoNumbersAreRefused) {
  const Scratch scratch;
  std::string text = ramp_text();
  text.replace(text.find("11"), 2, "x1");
  const std::string path =
      write_headed(scratch, "a.vtk", head("ASCII", "POINT_DATA 24\n") + scalars("a", "float", text));
  EXPECT_EQ(refusal(path), path +
                               ": array 'a': value 11 of its text is 'x1', no number of its type; correct it, or the "
                               "type in the header");
}

TEST(VtkLegacySource, NumberOfMoreThan400Characters_IsRefused) {
  const Scratch scratch;
  const auto with_first = [&](std::size_t threes) {
    std::string text = ramp_text();
    text.replace(0, 1, "0." + std::string(threes, '3'));
    return write_headed(scratch, "a.vtk", head("ASCII", "POINT_DATA 24\n") + scalars("a", "double", text));
  };
  std::vector<float> expected = ramp();
  expected[0] = 1.0F / 3.0F;
  EXPECT_EQ(read_volume(*open_source(with_first(398), {})), expected);
  for (const std::size_t threes : {std::size_t{399}, std::size_t{420}}) {
    const std::string path = with_first(threes);
    EXPECT_EQ(refusal(path),
              path + ": array 'a': value 0 of its text is longer than 400 characters; write it with fewer digits");
  }
}

TEST(VtkLegacySource, AFileCutAtAnyByteIsRefused) {
  const Scratch scratch;
  for (const bool binary : {true, false}) {
    const std::string values = binary ? chars(stored(telling_values<std::int16_t>(24), true)) : ramp_text() + "a";
    const std::string whole = head(binary ? "BINARY" : "ASCII", "POINT_DATA 24\n") + scalars("a", "short", values);
    for (std::size_t size = 1; size + 3 < whole.size(); ++size) {
      const std::string path = write_headed(scratch, "cut.vtk", whole.substr(0, size));
      if (!binary && size + 4 >= whole.size()) continue;  // a cut in the last number, 23, leaves 2, also a number
      const std::string message = refusal(path);
      ASSERT_FALSE(message.empty()) << size;
      ASSERT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

TEST(VtkLegacySource, ReadsThePublishedCarotid) {
  const auto packed = std::filesystem::path(WEIR_SOURCE_DIR) / "../shared/data/carotid_76x49x45_float32be.raw.xz";
  if (!std::filesystem::exists(packed)) GTEST_SKIP() << "skipped: no " << packed;
  const Scratch scratch;
  const std::string raw = scratch.path("carotid_76x49x45_float32be.raw");
  ASSERT_EQ(std::system(("xz -dc '" + packed.string() + "' > '" + raw + "'").c_str()), 0) << "xz-utils missing?";
  const std::string path = scratch.path("carotid.vtk");
  std::ofstream(path) << "# vtk DataFile Version 3.0\ncarotid\nBINARY\nDATASET STRUCTURED_POINTS\n"
                         "DIMENSIONS 76 49 45\nSPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 167580\n"
                         "SCALARS scalars float\nLOOKUP_TABLE default\n";
  ASSERT_EQ(std::system(("cat '" + raw + "' >> '" + path + "'").c_str()), 0);
  const auto volume = read_volume(*open_source(path, {}));
  EXPECT_EQ(volume, read_volume(*open_source(raw, {})));
  EXPECT_EQ(*std::max_element(volume.begin(), volume.end()), 580.0F);
}

}  // namespace
}  // namespace weir::vtk_legacy_source_test
