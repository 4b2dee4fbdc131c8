#include "ingest/vtk/vtk_legacy_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/source/extent.h"
#include "ingest/values/decode_doubles.h"
#include "ingest/vectors/voxel_components.h"
#include "ingest/vtk/vtk_legacy_text.h"

namespace weir {
namespace {

/// Keeps the list of arrays of a hostile file small.
constexpr std::size_t kMaxArrays = 4096;
constexpr std::uint64_t kMaxComponents = 1024;

struct LegacyType {
  std::string_view name;
  std::optional<ScalarType> scalar;  ///< nullopt if weir does not read the type
  std::uint64_t bits;                ///< bits of a value; 0 for text, because each text has its own length
};

// Type sizes as a 64-bit Linux writes them. vtkIdType is written as int (vtkDataWriter, WriteArray).
constexpr std::array<LegacyType, 14> kLegacyTypes{{{"unsigned_char", ScalarType::uint8, 8},
                                                   {"char", ScalarType::int8, 8},
                                                   {"signed_char", ScalarType::int8, 8},
                                                   {"unsigned_short", ScalarType::uint16, 16},
                                                   {"short", ScalarType::int16, 16},
                                                   {"unsigned_int", ScalarType::uint32, 32},
                                                   {"int", ScalarType::int32, 32},
                                                   {"vtkidtype", ScalarType::int32, 32},
                                                   {"unsigned_long", ScalarType::uint64, 64},
                                                   {"long", ScalarType::int64, 64},
                                                   {"vtktypeint64", ScalarType::int64, 64},
                                                   {"vtktypeuint64", ScalarType::uint64, 64},
                                                   {"float", ScalarType::float32, 32},
                                                   {"double", ScalarType::float64, 64}}};
constexpr LegacyType kBit{"bit", std::nullopt, 1};
constexpr std::array<LegacyType, 2> kStrings{{{"string", std::nullopt, 0}, {"utf8_string", std::nullopt, 0}}};

class LegacyParser {
 public:
  LegacyParser(std::istream& in, std::uint64_t size, const std::string& path) : text_(in, size, path) {}

  VtkLegacyHeader parse() {
    read_preamble();
    while (next_line()) {
      const std::string& key = words_[0];
      if (key == "point_data" || key == "cell_data") {
        begin_attributes(key == "cell_data");
      } else if (key == "field") {
        read_field();
      } else if (key == "metadata") {
        text_.skip_paragraph();
      } else if (in_attributes_) {
        read_attribute(key);
      } else {
        read_geometry(key);
      }
    }
    require_dimensions();
    tell_equal_names_apart(header_.arrays);
    return std::move(header_);
  }

 private:
  // Reads the words of the next line that has any. The first word is put in lower case because VTK ignores its case.
  bool next_line() {
    while (const auto line = text_.line()) {
      words_.clear();
      for (const std::string_view word : words(*line)) words_.emplace_back(word);
      if (words_.empty()) continue;
      words_[0] = lower_case(words_[0]);
      return true;
    }
    return false;
  }

  [[noreturn]] void wrong(const std::string& expected) const {
    std::string line;
    for (const std::string& word : words_) line += (line.empty() ? "" : " ") + word;
    text_.fail(cat(in_quotes(line), "; ", expected));
  }

  void read_preamble() {
    const auto first = text_.line();
    if (!first || !lower_case(*first).starts_with("# vtk datafile version")) {
      text_.fail("the file does not begin with '# vtk DataFile Version'");
    }
    text_.line();  // a title
    if (!next_line() || (words_[0] != "binary" && words_[0] != "ascii")) wrong("BINARY or ASCII belongs there");
    header_.binary = words_[0] == "binary";
    if (!next_line() || words_[0] != "dataset" || words_.size() != 2) wrong("DATASET and its kind belong there");
    if (lower_case(words_[1]) != "structured_points") {
      wrong("STRUCTURED_POINTS can be read; resample other data sets to it");
    }
  }

  std::uint64_t count(std::size_t word) const {
    const auto value = word < words_.size() ? parse_int(words_[word]) : std::nullopt;
    if (!value || *value < 0) wrong(cat("a count belongs at word ", word + 1));
    return static_cast<std::uint64_t>(*value);
  }

  Vector3 three_numbers() const {
    Vector3 values{};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto value = words_.size() == 4 ? parse_double(words_[a + 1]) : std::nullopt;
      if (!value) wrong("three numbers belong there");
      values[a] = *value;
    }
    return values;
  }

  void read_geometry(const std::string& key) {
    if (key == "dimensions") {
      if (words_.size() != 4) wrong("three counts belong there");
      const auto along = [this](std::size_t a) { return static_cast<std::int64_t>(count(a + 1)); };
      header_.image.points = {along(0), along(1), along(2)};
      checked_volume_bytes(header_.image.points, 1, text_.path());
      has_dimensions_ = true;
    } else if (key == "spacing" || key == "aspect_ratio") {
      header_.image.spacing = three_numbers();
    } else if (key == "origin") {
      header_.image.origin = three_numbers();
    } else {
      wrong("DIMENSIONS, SPACING, ORIGIN or POINT_DATA belongs there");
    }
  }

  void require_dimensions() const {
    if (!has_dimensions_) text_.fail("the file has no DIMENSIONS before its values; it is cut or damaged");
  }

  std::uint64_t values_expected() const {
    return static_cast<std::uint64_t>(volume(vtk_extent(header_.image, cells_)));
  }

  void begin_attributes(bool cells) {
    require_dimensions();
    cells_ = cells;
    in_attributes_ = true;
    if (count(1) != values_expected()) wrong(cat("DIMENSIONS make ", values_expected()));
  }

  void read_attribute(const std::string& key) {
    const std::uint64_t tuples = values_expected();
    if (key == "scalars") {
      VtkLegacyArray array = named_array();
      const std::uint64_t components = words_.size() > 3 ? count(3) : 1;
      if (!next_line() || words_[0] != "lookup_table") wrong("LOOKUP_TABLE belongs behind SCALARS");
      add(std::move(array), components, tuples);
    } else if (key == "color_scalars") {
      VtkLegacyArray array = named_array();
      array.type_name = "unsigned_char";
      array.fractions = !header_.binary;
      add(std::move(array), count(2), tuples);
    } else if (key == "lookup_table") {
      skip(header_.binary ? *type_of("unsigned_char") : *type_of("float"), 4, count(2));
    } else if (key == "texture_coordinates") {
      VtkLegacyArray array = named_array(3);
      add(std::move(array), count(2), tuples);
    } else if (key == "global_ids" || key == "pedigree_ids") {
      add(named_array(), 1, tuples);
    } else {
      constexpr std::array<std::pair<std::string_view, std::uint64_t>, 4> kWide{
          {{"vectors", 3}, {"normals", 3}, {"tensors", 9}, {"tensors6", 6}}};
      const auto* const wide = std::find_if(kWide.begin(), kWide.end(), [&](const auto& w) { return w.first == key; });
      if (wide == kWide.end()) wrong("SCALARS, FIELD or another attribute belongs there");
      add(named_array(), wide->second, tuples);
    }
  }

  // Before POINT_DATA these arrays belong to the data set and have any length. Of them, only the time is read.
  void read_field() {
    const std::uint64_t arrays = count(2);
    for (std::uint64_t i = 0; i < arrays; ++i) {
      if (!next_line()) wrong(cat("the field has ", arrays, " arrays; the file is cut"));
      if (words_[0] == "metadata") {
        text_.skip_paragraph();
        if (!next_line()) wrong(cat("the field has ", arrays, " arrays; the file is cut"));
      }
      if (words_.size() != 4) wrong("the name, components, tuples and type of an array belong there");
      // The name was put in lower case as a key.
      VtkLegacyArray array{{text_.first_word(), cells_, {}, words_[3], {}}, 0};
      const std::uint64_t components = count(1);
      const std::uint64_t tuples = count(2);
      if (in_attributes_ && tuples != values_expected()) wrong(cat("DIMENSIONS make ", values_expected(), " tuples"));
      if (in_attributes_) {
        add(std::move(array), components, tuples);
      } else {
        const LegacyType& type = required_type(array.type_name);
        if (array.name == "TimeValue" && components == 1 && tuples == 1 && type.scalar) {
          read_time(*type.scalar);
        } else {
          skip(type, components, tuples);
        }
      }
    }
  }

  // Reads the time of a step: one number. Anything else is not taken as a time.
  void read_time(ScalarType type) {
    std::array<std::byte, sizeof(double)> buffer{};
    const auto bytes = std::span(buffer).first(scalar_bytes(type));
    std::optional<double> value;
    if (header_.binary) {
      text_.read_bytes(bytes);
      value = decode_doubles(bytes, type, true, {}).front();
    } else {
      value = parse_double(text_.word());
    }
    if (value && std::isfinite(*value)) header_.time = value;
  }

  VtkLegacyArray named_array(std::size_t type_word = 2) const {
    if (words_.size() <= type_word) wrong("a name and a type belong there");
    return {{words_[1], cells_, {}, words_[type_word], {}}, 0};
  }

  static const LegacyType* type_of(std::string_view name) {
    const std::string lower = lower_case(name);
    if (lower == kBit.name) return &kBit;
    for (const LegacyType& string : kStrings) {
      if (lower == string.name) return &string;
    }
    const auto* const found = std::find_if(kLegacyTypes.begin(), kLegacyTypes.end(),
                                           [&](const LegacyType& type) { return type.name == lower; });
    return found == kLegacyTypes.end() ? nullptr : found;
  }

  const LegacyType& required_type(std::string_view name) const {
    const LegacyType* const type = type_of(name);
    if (type == nullptr) wrong(cat("the type ", in_quotes(name), " is not known, nor how long its values are"));
    return *type;
  }

  void add(VtkLegacyArray array, std::uint64_t components, std::uint64_t tuples) {
    if (header_.arrays.size() == kMaxArrays) text_.fail(cat("more than ", kMaxArrays, " arrays"));
    const LegacyType& type = required_type(array.type_name);
    array.name = decoded(array.name);
    array.offset = text_.position();
    if (!type.scalar) {
      array.obstacle = cat("its type is ", in_quotes(array.type_name), ", and char to double can be read");
    } else {
      array.type = *type.scalar;
    }
    skip(type, components, tuples);
    array.components = static_cast<std::int64_t>(components);
    if (array.obstacle.empty()) array.obstacle = components_obstacle(array.components);
    header_.arrays.push_back(std::move(array));
  }

  void skip(const LegacyType& type, std::uint64_t components, std::uint64_t tuples) {
    std::uint64_t values = 0;
    std::uint64_t bits = 0;
    if (components > kMaxComponents || __builtin_mul_overflow(components, tuples, &values) ||
        __builtin_mul_overflow(values, type.bits, &bits)) {
      wrong(cat(tuples, " tuples of ", components, " values are impossible"));
    }
    if (type.bits == 0) return header_.binary ? text_.skip_strings(values) : text_.skip_lines(values);
    if (header_.binary) {
      text_.skip_bytes(bits / 8 + (bits % 8 != 0 ? 1 : 0));
    } else {
      text_.skip_words(values);
    }
  }

  // vtkDataWriter::EncodeString writes a special character as % and two hexadecimal digits, a space as %20.
  static std::string decoded(std::string_view name) {
    std::string text;
    for (std::size_t i = 0; i < name.size(); ++i) {
      const auto digit = [&](std::size_t at) -> int {
        if (at >= name.size()) return -1;
        const std::size_t found = std::string_view("0123456789ABCDEF0123456789abcdef").find(name[at]);
        return found == std::string_view::npos ? -1 : static_cast<int>(found % 16);
      };
      if (name[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0) {
        text += static_cast<char>(16 * digit(i + 1) + digit(i + 2));
        i += 2;
      } else {
        text += name[i];
      }
    }
    return text;
  }

  VtkLegacyText text_;
  std::vector<std::string> words_;  ///< of the line being read
  VtkLegacyHeader header_;
  bool has_dimensions_ = false;
  bool in_attributes_ = false;
  bool cells_ = false;
};

}  // namespace

VtkLegacyHeader parse_vtk_legacy_header(std::istream& in, std::uint64_t size, const std::string& path) {
  return LegacyParser(in, size, path).parse();
}

}  // namespace weir
