#include "ingest/vtk/vtk_xml_source.h"

#include <cmath>
#include <filesystem>

#include "ingest/source_registry.h"
#include "tests/ingest/vtk/vtk_xml_file.h"

namespace weir::vtk_xml_source_test {
namespace {

enum class Form { raw, appended_base64, inline_base64 };

std::string file_of(std::span<const std::byte> values, const std::string& type, const VtiStorage& storage, Form form) {
  const VtiData data = vti_data(values, storage);
  const std::string attributes = "type=\"" + type + "\" Name=\"a\" ";
  if (form == Form::inline_base64) {
    return vti(storage, point_array(attributes + "format=\"binary\"", "\n   " + data.text(storage) + "\n  "));
  }
  // In the appended data, eight other bytes come first.
  const bool raw = form == Form::raw;
  return vti(storage, point_array(attributes + "format=\"appended\" offset=\"8\""),
             std::string("  <AppendedData encoding=\"") + (raw ? "raw" : "base64") + "\">\n   _" +
                 (raw ? std::string("<\"_>\0\n<\xFF", 8) + chars(data.raw()) : "AAAAAAAA" + data.text(storage)) +
                 "\n  </AppendedData>\n");
}

template <typename T>
void expect_type(const std::string& type) {
  const Scratch scratch;
  const auto values = telling_values<T>(24);
  for (const bool big : {false, true}) {
    for (const bool wide : {false, true}) {
      for (const std::size_t block : {std::size_t{0}, std::size_t{8}, std::size_t{16}, std::size_t{4096}}) {
        for (const Form form : {Form::raw, Form::appended_base64, Form::inline_base64}) {
          SCOPED_TRACE(testing::Message() << type << ' ' << big << wide << ' ' << block << ' ' << int(form));
          const VtiStorage storage{big, wide, block};
          const std::string path = write_headed(scratch, "a.vti", file_of(stored(values, big), type, storage, form));
          const auto source = open_source(path, {});
          EXPECT_EQ(source->info().format, "vtk-xml");
          EXPECT_EQ(source->info().dataset, "a");
          EXPECT_EQ(source->info().extent, (Index3{4, 3, 2}));
          EXPECT_EQ(source->info().file_bytes, std::filesystem::file_size(path));
          EXPECT_EQ(read_volume(*source), as_floats(values));
        }
      }
    }
  }
}

std::vector<std::uint8_t> ramp() {
  std::vector<std::uint8_t> values(24);
  for (std::size_t i = 0; i < 24; ++i) values[i] = static_cast<std::uint8_t>(i);
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

TEST(VtkXmlSource, ReadsEveryTypeInEveryForm) {
  expect_type<std::int8_t>("Int8");
  expect_type<std::uint8_t>("UInt8");
  expect_type<std::int16_t>("Int16");
  expect_type<std::uint16_t>("UInt16");
  expect_type<std::int32_t>("Int32");
  expect_type<std::uint32_t>("UInt32");
  expect_type<std::int64_t>("Int64");
  expect_type<std::uint64_t>("UInt64");
  expect_type<float>("Float32");
  expect_type<double>("Float64");
}

TEST(VtkXmlSource, ReadsText) {
  const Scratch scratch;
  const auto open = [&](const std::string& type, const std::string& text) {
    const std::string array = point_array("type=\"" + type + "\" Name=\"a\" format=\"ascii\"", text);
    return open_source(write_headed(scratch, "a.vti", vti({true}, array)), {});
  };
  std::string text;
  for (int i = 0; i < 21; ++i) text += std::to_string(i) + (i % 6 == 5 ? "\n " : " ");
  const auto whole = read_volume(*open("Int8", text + "-128 +5\t127\n"));
  EXPECT_EQ(whole[20], 20.0F);
  EXPECT_EQ(whole[21], -128.0F);
  EXPECT_EQ(whole[22], 5.0F);
  EXPECT_EQ(whole[23], 127.0F);
  const auto real = read_volume(*open("Float32", text + "0.1 -1e-60 nan"));
  EXPECT_EQ(real[21], 0.1F);
  EXPECT_EQ(real[22], 0.0F);
  EXPECT_TRUE(std::isnan(real[23]));
  const std::string where = scratch.path("a.vti") + ": array 'a': ";
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open("UInt8", text + "1 2"); }),
            where + "has 23 values as text, and its header asks for 24; the file is cut or damaged");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open("UInt8", text + "1 256 2"); }),
            where + "value 22 of its text is '256', no number of its type; correct it, or the type in the header");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open("Int8", text + "1 2 3 4.5"); }),
            where + "'4.5' follows the 24 values that its header asks for; one of the two is damaged");
}

TEST(VtkXmlSource, TakesPlaceFirstIndexAndDirection) {
  const Scratch scratch;
  const VtiStorage storage;
  std::string text = vti(storage, point_array("type=\"UInt8\" Name=\"a\" format=\"binary\"",
                                              vti_data(stored(ramp()), storage).text(storage)));
  const auto with = [&](const std::string& extent, const std::string& placement) {
    std::string changed = text;
    changed.replace(changed.find("WholeExtent=\"0 3 0 2 0 1\""), 25, "WholeExtent=\"" + extent + "\" " + placement);
    changed.replace(changed.find("Piece Extent=\"0 3 0 2 0 1\""), 26, "Piece Extent=\"" + extent + "\"");
    return write_headed(scratch, "a.vti", changed);
  };
  const auto source = open_source(with("-2 1 5 7 0 1", "Origin=\"1 2 3\" Spacing=\"0.5 0.25 2\""), {});
  EXPECT_EQ(source->info().domain(), (Box{{-2, 5, 0}, {2, 8, 2}}));
  EXPECT_EQ(source->info().spacing, (std::array<double, 3>{0.5, 0.25, 2}));
  EXPECT_EQ(source->info().origin, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(read_volume(*source), as_floats(ramp()));

  // Column a is the direction of axis a: x runs along +y of the world, y along -x.
  const std::string turned =
      with("0 3 0 2 0 1", "Origin=\"1 2 3\" Spacing=\"0.5 0.25 2\" Direction=\"0 -1 0 1 0 0 0 0 1\"");
  EXPECT_EQ(open_source(turned, {})->info().spacing, (std::array<double, 3>{0.5, 0.25, 2}));
  const auto attributes = list_vtk_xml(turned, {}).at(0).attributes;
  EXPECT_EQ(attributes.at(2).second, "axes along +y, -x, +z of the file's world; voxels keep the file's order");

  EXPECT_EQ(refusal(with("0 3 0 2 0 1", "Spacing=\"1 0 1\"")),
            scratch.path("a.vti") +
                ": spacing 1 0 1 and origin 0 0 0, with the direction, are no place: each must be "
                "finite, the spacing not 0");
}

// vtkImageData::TransformIndexToPhysicalPoint: origin + direction * (spacing * index).
TEST(VtkXmlSource, FirstPointOfAFallingAxis_LiesWhereVtkPutsIt) {
  const Scratch scratch;
  const VtiStorage storage;
  std::string text = vti(storage, point_array("type=\"UInt8\" Name=\"a\" format=\"binary\"",
                                              vti_data(stored(ramp()), storage).text(storage)));
  const std::string extent = "3 6 -2 0 5 6";
  const std::string place = "Origin=\"1 2 3\" Spacing=\"0.5 0.25 2\" Direction=\"0 1 0 1 0 0 0 0 -1\"";
  text.replace(text.find("WholeExtent=\"0 3 0 2 0 1\""), 25, "WholeExtent=\"" + extent + "\" " + place);
  text.replace(text.find("Piece Extent=\"0 3 0 2 0 1\""), 26, "Piece Extent=\"" + extent + "\"");
  const std::string path = write_headed(scratch, "a.vti", text);
  const SourceInfo info = open_source(path, {})->info();
  EXPECT_EQ(info.index_origin, (Index3{3, -2, 5}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{2, 1, -17})) << "z of the first point is 3 - 5 * 2 = -17 + 5 * 2";
  EXPECT_EQ(list_vtk_xml(path, {}).at(0).attributes.at(2).second, "2,1,-17");
}

TEST(VtkXmlSource, CellValuesArePlacedAtCellCentres) {
  const Scratch scratch;
  const std::string cells =
      "<CellData><DataArray type=\"UInt8\" Name=\"a\" format=\"ascii\">1 2 3 4 5 6</DataArray></CellData>";
  const auto source =
      open_source(write_headed(scratch, "a.vti", vti({}, cells, "", " Origin=\"10 0 0\" Spacing=\"2 4 8\"")), {});
  EXPECT_EQ(source->info().extent, (Index3{3, 2, 1}));
  EXPECT_EQ(source->info().origin, (std::array<double, 3>{11, 2, 4}));
  EXPECT_EQ(read_volume(*source), (std::vector<float>{1, 2, 3, 4, 5, 6}));
}

TEST(VtkXmlSource, CellsOfAFlatImage_LieInItsPlane) {
  const Scratch scratch;
  std::string values;
  for (int i = 0; i < 64; ++i) values += cat(i, ' ');
  std::string text = vti({}, "<CellData><DataArray type=\"UInt8\" Name=\"a\">" + values + "</DataArray></CellData>", "",
                         " Origin=\"0 0 5\" Spacing=\"1 1 2\"");
  const std::string extent = "0 3 0 2 0 1";
  for (std::size_t at = text.find(extent); at != std::string::npos; at = text.find(extent)) {
    text.replace(at, extent.size(), "0 8 0 8 0 0");
  }
  const std::string path = write_headed(scratch, "a.vti", text);
  const SourceInfo info = open_source(path, {})->info();
  EXPECT_EQ(info.extent, (Index3{8, 8, 1}));
  EXPECT_EQ(info.origin, (std::array<double, 3>{0.5, 0.5, 5}));
  EXPECT_EQ(list_vtk_xml(path, {}).at(0).attributes.at(1),
            (std::pair<std::string, std::string>{"origin", "0.5,0.5,5"}));
}

TEST(VtkXmlSource, ChoosesByNameOrByTheFilesMark) {
  const Scratch scratch;
  const auto array = [](const std::string& name, const std::string& value, const std::string& more = "") {
    std::string text;
    for (int i = 0; i < 24; ++i) text += value + " ";
    return "<DataArray type=\"UInt8\" Name=\"" + name + "\"" + more + ">" + text + "</DataArray>";
  };
  const std::string arrays = array("a", "1") + array("b", "2") + array("v", "3", " NumberOfComponents=\"3\"") +
                             "<Array type=\"String\" Name=\"s\"/>";
  std::string path = write_headed(scratch, "a.vti", vti({}, "<PointData Scalars=\"b\">" + arrays + "</PointData>"));
  EXPECT_EQ(open_source(path, {})->info().dataset, "b");
  EXPECT_EQ(read_volume(*open_source(path, naming("a")))[23], 1.0F);
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(path, naming("v")); }),
            path + ": array 'v': has 3 components a voxel; give --component: 0 to 2, x, y, z or magnitude");
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, naming("c")); }),
            path + ": has no array 'c'; it has 'a', 'b', 'v'");
  path = write_headed(scratch, "a.vti", vti({}, "<PointData>" + arrays + "</PointData>"));
  EXPECT_EQ(refusal(path, ErrorKind::usage),
            path + ": holds 2 arrays that can be converted; name an array with --dataset: 'a', 'b'");
  path = write_headed(scratch, "a.vti",
                      vti({}, "<PointData Scalars=\"a\">" + array("a", "1") + "</PointData><CellData>" +
                                  "<DataArray type=\"UInt8\" Name=\"a\">1 2 3 4 5 6</DataArray></CellData>"));
  EXPECT_EQ(open_source(path, {})->info().dataset, "PointData/a");
  EXPECT_EQ(read_volume(*open_source(path, naming("CellData/a")))[5], 6.0F);
}

SourceOptions component(const std::string& text, const std::string& dataset = "") {
  SourceOptions options = naming(dataset);
  options.component = parse_component(text);
  return options;
}

// Returns the vector (i, 2 i, -2 i) for each voxel i. Its length is 3 i.
std::vector<double> telling_vectors() {
  std::vector<double> values;
  for (int i = 0; i < 24; ++i) values.insert(values.end(), {1.0 * i, 2.0 * i, -2.0 * i});
  return values;
}

std::vector<float> multiples(float factor) {
  std::vector<float> values;
  for (int i = 0; i < 24; ++i) values.push_back(factor * static_cast<float>(i));
  return values;
}

TEST(VtkXmlSource, ComponentOfVectors_IsTheVolume_HoweverTheyAreStored) {
  const Scratch scratch;
  const std::string head = "type=\"Float64\" Name=\"v\" NumberOfComponents=\"3\" ";
  std::string text;
  for (const double value : telling_vectors()) text += cat(value, " ");
  std::vector<std::string> files{vti({}, point_array(head + "format=\"ascii\"", text))};
  for (const VtiStorage& storage : {VtiStorage{true, false, 0}, VtiStorage{false, true, 100}}) {
    const VtiData data = vti_data(stored(telling_vectors(), storage.big_endian), storage);
    files.push_back(vti(storage, point_array(head + "format=\"binary\"", data.text(storage))));
    files.push_back(vti(storage, point_array(head + "format=\"appended\" offset=\"0\""),
                        "<AppendedData encoding=\"raw\">_" + chars(data.raw()) + "</AppendedData>"));
  }
  for (const std::string& content : files) {
    const std::string path = write_headed(scratch, "a.vti", content);
    EXPECT_EQ(read_volume(*open_source(path, component("0"))), multiples(1));
    EXPECT_EQ(read_volume(*open_source(path, component("z"))), multiples(-2));
    const auto length = open_source(path, component("magnitude", "v"));
    EXPECT_EQ(length->info().extent, (Index3{4, 3, 2}));
    EXPECT_EQ(length->info().details.component, "magnitude");
    EXPECT_EQ(read_volume(*length), multiples(3));
  }
}

TEST(VtkXmlSource, ComponentThatDoesNotFit_IsRefused) {
  const Scratch scratch;
  const auto array = [](const std::string& name, int components) {
    std::string text;
    for (int i = 0; i < 24 * components; ++i) text += "1 ";
    return cat("<DataArray type=\"UInt8\" Name=\"", name, "\" NumberOfComponents=\"", components, "\">", text,
               "</DataArray>");
  };
  const std::string path = write_headed(
      scratch, "a.vti", vti({}, "<PointData>" + array("a", 1) + array("t", 9) + array("w", 65) + "</PointData>"));
  const auto refused = [&](const SourceOptions& options, ErrorKind kind = ErrorKind::usage) {
    return message_of_error(kind, [&] { open_source(path, options); });
  };
  EXPECT_EQ(open_source(path, {})->info().dataset, "a");
  EXPECT_EQ(open_source(path, component("8"))->info().dataset, "t");
  EXPECT_EQ(refused(component("0", "a")),
            path + ": array 'a': has one value a voxel, and no components; leave --component out");
  EXPECT_EQ(refused(component("9")),
            path + ": array 't': has 9 components a voxel, and --component is 9; give 0 to 8 or magnitude");
  EXPECT_EQ(refused(naming("t")),
            path + ": array 't': has 9 components a voxel; give --component: 0 to 8 or magnitude");
  EXPECT_EQ(refused(component("0", "w"), ErrorKind::input),
            path + ": array 'w' cannot be converted: it has 65 components, and one of 1 to 64 can be read");
}

TEST(VtkXmlSource, ListsTypeLayoutAndAttributes) {
  const Scratch scratch;
  const std::string path = write_headed(
      scratch, "a.vti", file_of(stored(telling_values<float>(24), true), "Float32", {true, false, 8}, Form::raw));
  const auto list = list_vtk_xml(path, {});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].name, "a");
  EXPECT_EQ(list[0].extents, (std::vector<std::int64_t>{4, 3, 2}));
  EXPECT_EQ(list[0].type, "big-endian float32");
  EXPECT_EQ(list[0].layout, "appended, zlib blocks");
  EXPECT_EQ(list[0].attributes, (std::vector<std::pair<std::string, std::string>>{
                                    {"spacing", "1,1,1"}, {"origin", "0,0,0"}, {"values of", "points"}}));
}

TEST(VtkXmlSource, AFileCutAtAnyByteIsRefused) {
  const Scratch scratch;
  for (const Form form : {Form::raw, Form::appended_base64, Form::inline_base64}) {
    for (const std::size_t block : {std::size_t{0}, std::size_t{8}}) {
      const std::string whole = file_of(stored(ramp()), "UInt8", {false, false, block}, form);
      // The reader does not need the part of the file that follows the values.
      const std::size_t end = form == Form::inline_base64 ? whole.rfind("/VTKFile>") : whole.rfind("\n  </Appended");
      for (std::size_t size = 1; size < end; ++size) {
        const std::string message = refusal(write_headed(scratch, "cut.vti", whole.substr(0, size)));
        ASSERT_FALSE(message.empty()) << size;
        ASSERT_EQ(message.find('\n'), std::string::npos) << message;
      }
    }
  }
}

TEST(VtkXmlSource, WrongBlockSizesAreRefused) {
  const Scratch scratch;
  const std::string path = scratch.path("a.vti");
  const auto refuse = [&](const VtiStorage& storage, const std::vector<std::uint64_t>& sizes,
                          std::span<const std::byte> values) {
    const VtiData data{storage.words(sizes), {values.begin(), values.end()}};
    return refusal(
        write_headed(scratch, "a.vti",
                     vti(storage, point_array("type=\"UInt8\" Name=\"a\" format=\"binary\"", data.text(storage)))));
  };
  const auto plain = stored(ramp());
  EXPECT_EQ(refuse({}, {25}, plain),
            path + ": array 'a': holds 25 bytes, and its header asks for 24; one of the two is damaged");
  const VtiStorage packed{false, true, 16};
  const auto bytes = deflated(std::vector<std::byte>(16), Wrapper::zlib);
  const std::uint64_t n = bytes.size();
  for (const auto& [blocks, size, last] : std::vector<std::array<std::uint64_t, 3>>{{0, 24, 0},
                                                                                    {1, 0, 24},
                                                                                    {2, 16, 16},
                                                                                    {2, 16, 0},
                                                                                    {1, 16, 24},
                                                                                    {~std::uint64_t{0}, 2, 26},
                                                                                    {std::uint64_t{1} << 61U, 8, 0}}) {
    EXPECT_EQ(refuse(packed, {blocks, size, last, n, n}, bytes),
              path + ": array 'a': " + std::to_string(blocks) + " blocks of " + std::to_string(size) +
                  " bytes, the last of " + std::to_string(last == 0 ? size : last) +
                  ", do not make the 24 that its header asks for");
  }
  const std::string more = refuse(packed, {2, 16, 8, ~std::uint64_t{0}, n}, bytes);
  EXPECT_TRUE(more.starts_with(path + ": array 'a': ")) << more;
  const auto bomb = deflated(std::vector<std::byte>(std::size_t{32} << 20U), Wrapper::zlib);
  const std::string inflated = refuse(packed, {2, 16, 8, bomb.size(), n}, bomb);
  EXPECT_TRUE(inflated.starts_with(path + ": array 'a': block 0: holds ")) << inflated;
  EXPECT_TRUE(inflated.ends_with(" bytes, and its header asks for 16; one of the two is damaged")) << inflated;
  const auto damaged = std::vector<std::byte>(20, std::byte{0x55});
  EXPECT_TRUE(refuse(packed, {2, 16, 8, 20, 20}, damaged).starts_with(path + ": array 'a': block 0: damaged"));
}

TEST(VtkXmlSource, ExtentBeyondTheFileSizeIsRefused) {
  const Scratch scratch;
  std::string text = vti({}, point_array("type=\"Float64\" Name=\"a\" format=\"ascii\"", "1 2 3"));
  for (const std::string from : {"WholeExtent=\"0 3 0 2 0 1\"", "Piece Extent=\"0 3 0 2 0 1\""}) {
    text.replace(text.find(from) + from.size() - 12, 11, "0 999999 0 999999 0 99");
  }
  const std::string path = write_headed(scratch, "a.vti", text);
  EXPECT_EQ(refusal(path), path +
                               ": array 'a': 5 bytes of the file cannot hold the 800000000000000 that its header "
                               "asks for; the file is cut or one of the two damaged");
}

TEST(VtkXmlSource, Base64OfOtherCharactersIsRefused) {
  const Scratch scratch;
  const auto refuse = [&](const std::string& text) {
    const std::string path = write_headed(scratch, "a.vti",
                                          vti({}, "<PointData><DataArray type=\"UInt8\" Name=\"a\" format=\"binary\">" +
                                                      text + "</DataArray></PointData>"));
    return refusal(path).substr(path.size());
  };
  const std::string good = vti_data(stored(ramp()), {}).text({});
  EXPECT_EQ(refuse(good.substr(0, 10) + "*" + good.substr(11)),
            ": array 'a': its base64 text has the character '*'; it ends too early or is damaged");
  EXPECT_EQ(refuse(good.substr(0, 32)), ": array 'a': its base64 text ends too early; the file is cut or damaged");
}

TEST(VtkXmlSource, ReadsSizesAndValuesEncodedSeparately) {
  const Scratch scratch;
  const VtiData data = vti_data(stored(ramp()), {});
  const std::string path = write_headed(scratch, "a.vti",
                                        vti({}, point_array("type=\"UInt8\" Name=\"a\" format=\"binary\"",
                                                            base64(data.sizes) + "\n" + base64(data.values))));
  EXPECT_EQ(read_volume(*open_source(path, {})), as_floats(ramp()));
}

}  // namespace
}  // namespace weir::vtk_xml_source_test
