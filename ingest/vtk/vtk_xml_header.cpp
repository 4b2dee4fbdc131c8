#include "ingest/vtk/vtk_xml_header.h"

#include <algorithm>
#include <array>
#include <pugixml.hpp>
#include <string_view>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/vectors/voxel_components.h"

namespace weir {
namespace {

using TypeName = std::pair<std::string_view, ScalarType>;
constexpr std::array<TypeName, 10> kXmlTypes{{{"Int8", ScalarType::int8},
                                              {"UInt8", ScalarType::uint8},
                                              {"Int16", ScalarType::int16},
                                              {"UInt16", ScalarType::uint16},
                                              {"Int32", ScalarType::int32},
                                              {"UInt32", ScalarType::uint32},
                                              {"Int64", ScalarType::int64},
                                              {"UInt64", ScalarType::uint64},
                                              {"Float32", ScalarType::float32},
                                              {"Float64", ScalarType::float64}}};

class XmlParser {
 public:
  explicit XmlParser(const std::string& path) : path_(path) {}

  VtkXmlHeader parse(const VtkXmlSkeleton& skeleton) {
    const std::string xml = skeleton.xml();
    pugi::xml_document document;
    if (const auto result = document.load_buffer(xml.data(), xml.size()); !result) {
      throw Error(ErrorKind::input,
                  cat(path_, ": its XML cannot be read (", result.description(), "); is the file complete?"));
    }
    header_.appended = skeleton.appended();
    const pugi::xml_node file = document.child("VTKFile");
    read_file(file);
    const pugi::xml_node image = required_child(file, "ImageData");
    read_image(image);
    read_time(image.child("FieldData"));
    const pugi::xml_node piece = required_child(image, "Piece");
    if (piece.next_sibling("Piece")) {
      const auto pieces = image.children("Piece");
      throw Error(ErrorKind::input, cat(path_, ": holds ", std::distance(pieces.begin(), pieces.end()),
                                        " pieces, and one can be read; write the image as a whole"));
    }
    if (const auto extent = extent_of(piece, "Extent"); extent != extent_of(image, "WholeExtent")) {
      wrong(piece, "Extent",
            cat("the image's WholeExtent is ", in_quotes(image.attribute("WholeExtent").value()),
                ", and one piece with all of it can be read"));
    }
    read_arrays(piece.child("PointData"), false);
    read_arrays(piece.child("CellData"), true);
    if (tell_equal_names_apart(header_.arrays).contains(header_.scalars)) {
      header_.scalars = full_vtk_name(header_.scalars, false);
    }
    return std::move(header_);
  }

 private:
  [[noreturn]] void wrong(const pugi::xml_node& node, const char* attribute, const std::string& expected) const {
    const pugi::xml_attribute found = node.attribute(attribute);
    throw Error(ErrorKind::input, cat(path_, ": ", attribute, " of ", node.name(), " is ",
                                      found ? in_quotes(found.value()) : "missing", "; ", expected));
  }

  pugi::xml_node required_child(const pugi::xml_node& node, const char* name) const {
    const pugi::xml_node child = node.child(name);
    if (!child) {
      throw Error(ErrorKind::input, cat(path_, ": has no ", name, " in its ", node.name(), "; this is no VTK image"));
    }
    return child;
  }

  void read_file(const pugi::xml_node& file) {
    if (!file) throw Error(ErrorKind::input, cat(path_, ": its XML has no VTKFile; this is no VTK image file"));
    const std::string_view type = file.attribute("type").value();
    if (type == "PImageData") wrong(file, "type", "write its pieces as one .vti file, or name one of them");
    if (type != "ImageData") {
      wrong(file, "type", "ImageData can be read; resample other grids to an image");
    }
    const std::string_view order = file.attribute("byte_order").value();
    if (order != "LittleEndian" && order != "BigEndian") wrong(file, "byte_order", "LittleEndian or BigEndian");
    header_.big_endian = order == "BigEndian";
    const std::string_view word = file.attribute("header_type").as_string("UInt32");
    if (word != "UInt32" && word != "UInt64") wrong(file, "header_type", "UInt32 or UInt64");
    header_.word_bytes = word == "UInt64" ? 8 : 4;
    const std::string_view compressor = file.attribute("compressor").value();
    header_.zlib = compressor == "vtkZLibDataCompressor";
    if (!compressor.empty() && !header_.zlib) {
      wrong(file, "compressor", "vtkZLibDataCompressor can be read; write the file with it or without compression");
    }
    if (const pugi::xml_node appended = file.child("AppendedData")) {
      const std::string_view encoding = appended.attribute("encoding").value();
      if (encoding != "raw" && encoding != "base64") wrong(appended, "encoding", "raw or base64");
      header_.appended_base64 = encoding == "base64";
    }
  }

  /// Returns the first and last index along x, y, z.
  std::array<std::int64_t, 6> extent_of(const pugi::xml_node& node, const char* attribute) const {
    const auto numbers = parse_ints(node.attribute(attribute).value());
    // Valid indices fit 32 bits, so sums of them fit 64.
    constexpr std::int64_t kMost = std::int64_t{1} << 31U;
    const auto small = [](std::int64_t v) { return v >= -kMost && v < kMost; };
    if (!numbers || numbers->size() != 6 || !std::all_of(numbers->begin(), numbers->end(), small)) {
      wrong(node, attribute, "six whole numbers of 32 bits belong there, first and last index along x, y, z");
    }
    std::array<std::int64_t, 6> extent{};
    std::copy(numbers->begin(), numbers->end(), extent.begin());
    for (std::size_t a = 0; a < 6; a += 2) {
      if (extent[a + 1] < extent[a]) wrong(node, attribute, "the image has no point");
    }
    return extent;
  }

  template <std::size_t Count>
  void read_numbers(const pugi::xml_node& node, const char* attribute, std::array<double, Count>& into) const {
    if (!node.attribute(attribute)) return;
    const auto numbers = parse_doubles(node.attribute(attribute).value());
    if (!numbers || numbers->size() != Count) wrong(node, attribute, cat(Count, " numbers belong there"));
    std::copy(numbers->begin(), numbers->end(), into.begin());
  }

  void read_image(const pugi::xml_node& node) {
    const auto e = extent_of(node, "WholeExtent");
    header_.image.first = {e[0], e[2], e[4]};
    header_.image.points = {e[1] - e[0] + 1, e[3] - e[2] + 1, e[5] - e[4] + 1};
    read_numbers(node, "Origin", header_.image.origin);
    read_numbers(node, "Spacing", header_.image.spacing);
    read_numbers(node, "Direction", header_.image.direction);
  }

  void read_arrays(const pugi::xml_node& data, bool cells) {
    if (header_.scalars.empty()) header_.scalars = data.attribute("Scalars").value();
    for (const pugi::xml_node& node : data.children()) {
      if (std::string_view(node.name()) == "DataArray") header_.arrays.push_back(read_array(node, cells));
    }
  }

  /// Reads the time of a step as vtkXMLWriter writes it. An array of another length is something else.
  void read_time(const pugi::xml_node& fields) {
    const pugi::xml_node node = fields.find_child_by_attribute("DataArray", "Name", "TimeValue");
    if (!node || std::string_view(node.attribute("NumberOfTuples").as_string("1")) != "1") return;
    try {
      VtkXmlArray array = read_array(node, false);
      if (array.components == 1) header_.time = std::move(array);
    } catch (const Error& error) {  // the volume is read without it, and that is said
      header_.time.emplace();
      header_.time->obstacle = error.what();
    }
  }

  VtkXmlArray read_array(const pugi::xml_node& node, bool cells) const {
    VtkXmlArray array;
    array.name = node.attribute("Name").value();
    array.cells = cells;
    array.type_name = node.attribute("type").value();
    const auto* const type =
        std::find_if(kXmlTypes.begin(), kXmlTypes.end(), [&](const TypeName& t) { return t.first == array.type_name; });
    if (type == kXmlTypes.end()) {
      array.obstacle = cat("its type is ", in_quotes(array.type_name), ", and Int8 to Float64 can be read");
    } else {
      array.type = type->second;
    }
    const auto components = parse_int(node.attribute("NumberOfComponents").as_string("1"));
    array.components = components.value_or(0);
    if (array.obstacle.empty()) {
      array.obstacle = components ? components_obstacle(*components) : "its NumberOfComponents is no whole number";
    }
    const auto least = parse_double(node.attribute("RangeMin").value());
    const auto largest = parse_double(node.attribute("RangeMax").value());
    if (least && largest) array.range = {*least, *largest};
    read_place(node, array);
    return array;
  }

  void read_place(const pugi::xml_node& node, VtkXmlArray& array) const {
    const std::string_view format = node.attribute("format").as_string("ascii");
    if (format == "appended") {
      array.format = VtkXmlArray::Format::appended;
      const auto offset = parse_int(node.attribute("offset").value());
      if (!offset || *offset < 0) wrong(node, "offset", "a byte count in the appended data belongs there");
      if (!header_.appended) wrong(node, "format", "and the file has no appended data; is it complete?");
      array.begin = static_cast<std::uint64_t>(*offset);
      return;
    }
    if (format != "ascii" && format != "binary") wrong(node, "format", "ascii, binary or appended");
    array.format = format == "ascii" ? VtkXmlArray::Format::ascii : VtkXmlArray::Format::binary;
    // VtkXmlSkeleton puts this range in place of a text.
    const auto range = parse_ints(node.child_value());
    if (!range || range->size() != 2 || range->front() < 0 || range->back() < range->front()) {
      if (array.obstacle.empty()) array.obstacle = "it holds no data";
      return;
    }
    array.begin = static_cast<std::uint64_t>(range->front());
    array.end = static_cast<std::uint64_t>(range->back());
  }

  const std::string& path_;
  VtkXmlHeader header_;
};

}  // namespace

VtkXmlHeader parse_vtk_xml_header(const VtkXmlSkeleton& skeleton, const std::string& path) {
  return XmlParser(path).parse(skeleton);
}

}  // namespace weir
