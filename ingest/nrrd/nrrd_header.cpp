#include "ingest/nrrd/nrrd_header.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

constexpr std::int64_t kMaxDimension = 16;  ///< NRRD_DIM_MAX

struct Field {
  std::string_view value;
  std::size_t line = 0;
};

using TypeNames = std::pair<ScalarType, std::string_view>;
// The names of section 5.1, without the blanks inside names. Each name has a blank before and after it.
constexpr std::array<TypeNames, 10> kNrrdTypes{
    {{ScalarType::int8, " signedchar int8 int8_t "},
     {ScalarType::uint8, " uchar unsignedchar uint8 uint8_t "},
     {ScalarType::int16, " short shortint signedshort signedshortint int16 int16_t "},
     {ScalarType::uint16, " ushort unsignedshort unsignedshortint uint16 uint16_t "},
     {ScalarType::int32, " int signedint int32 int32_t "},
     {ScalarType::uint32, " uint unsignedint uint32 uint32_t "},
     {ScalarType::int64, " longlong longlongint signedlonglong signedlonglongint int64 int64_t "},
     {ScalarType::uint64, " ulonglong unsignedlonglong unsignedlonglongint uint64 uint64_t "},
     {ScalarType::float32, " float "},
     {ScalarType::float64, " double "}}};

/// The fields of a header by their names, in lower case and without blanks ("data file" is also written "datafile").
class Fields {
 public:
  Fields(std::string_view text, bool whole, const std::string& path) : path_(path) {
    if (!text.starts_with(kNrrdMagic)) {
      throw Error(ErrorKind::input, cat(path, ": does not begin with ", kNrrdMagic, kNotAsNamed));
    }
    LineReader lines(text);
    const std::string_view magic = *lines.next();
    const std::string_view version = magic.substr(kNrrdMagic.size());
    if (version.size() != 1 || version[0] < '1' || version[0] > '5') {
      throw Error(ErrorKind::input,
                  cat(path, ": begins with ", in_quotes(magic), "; versions NRRD0001 to NRRD0005 can be read"));
    }
    while (const auto line = lines.next()) {
      if (lines.open_ended() && !whole) break;
      if (line->empty()) {
        header_bytes_ = lines.position();
        return;
      }
      add(*line, lines.number());
    }
    if (!whole) {
      throw Error(ErrorKind::input, cat(path, ": its header does not end within ", kHeaderLimit, " bytes"));
    }
    header_bytes_ = text.size();
    ended_by_file_ = true;
  }

  std::size_t header_bytes() const { return header_bytes_; }
  bool ended_by_file() const { return ended_by_file_; }

  const Field* find(const std::string& name) const {
    const auto found = fields_.find(name);
    return found == fields_.end() ? nullptr : &found->second;
  }
  const Field& required(const std::string& name) const {
    if (const Field* field = find(name)) return *field;
    throw Error(ErrorKind::input, cat(path_, ": its header has no field '", name, "'"));
  }
  Error wrong(const std::string& name, const Message& expected) const {
    const Field& field = required(name);
    return Error(ErrorKind::input,
                 compose(path_, ": line ", field.line, ": ", name, " is ", in_quotes(field.value), "; ", expected));
  }
  std::string_view value(const std::string& name) const {
    const Field* field = find(name);
    return field == nullptr ? std::string_view() : field->value;
  }

 private:
  void add(std::string_view line, std::size_t number) {
    if (line.front() == '#') return;
    // A key (up to the first ":=") and a field's name (up to the first ": ") may themselves contain colons.
    const std::size_t pair = line.find(":=");
    const std::size_t field = line.find(": ");
    if (pair != std::string_view::npos && pair < field) return;  // key:=value pairs are comments for people
    const std::size_t colon = field != std::string_view::npos ? field : line.find(':');
    if (colon == std::string_view::npos) {
      throw Error(ErrorKind::input, cat(path_, ": line ", number, " of its header is ", in_quotes(line),
                                        ", neither a field nor a comment"));
    }
    std::string name = lower_case(line.substr(0, colon));
    std::erase(name, ' ');
    if (name == "centers") name = "centerings";
    if (!fields_.emplace(name, Field{trimmed(line.substr(colon + 1)), number}).second) {
      throw Error(ErrorKind::input,
                  cat(path_, ": line ", number, " of its header gives ", in_quotes(name), " a second time"));
    }
    // The lines after LIST are names of files, not fields, so reading must stop here.
    const std::string_view value = fields_[name].value;
    if (name == "datafile" && (value.starts_with("LIST") || value.find('%') != std::string_view::npos)) {
      throw wrong(name,
                  compose("one file for all values can be read; stack the files of a list with ", option("stack")));
    }
  }

  const std::string& path_;
  std::map<std::string, Field, std::less<>> fields_;
  std::size_t header_bytes_ = 0;
  bool ended_by_file_ = false;
};

ScalarType type_of(const Fields& fields) {
  std::string name = lower_case(fields.required("type").value);
  std::erase(name, ' ');
  const std::string framed = ' ' + name + ' ';
  const auto* const found = std::find_if(kNrrdTypes.begin(), kNrrdTypes.end(), [&](const TypeNames& t) {
    return t.second.find(framed) != std::string_view::npos;
  });
  if (found == kNrrdTypes.end() || name.empty()) {
    throw fields.wrong("type", "integers of 8 to 64 bits, float and double can be read");
  }
  return found->first;
}

bool is_gzip(const Fields& fields) {
  const std::string encoding = lower_case(fields.required("encoding").value);
  if (encoding == "raw") return false;
  if (encoding == "gzip" || encoding == "gz") return true;
  throw fields.wrong("encoding", "raw and gzip can be read; convert it with `unu save -f nrrd -e gzip`");
}

bool is_big_endian(const Fields& fields, ScalarType type) {
  if (fields.find("endian") == nullptr && scalar_bytes(type) == 1) return false;
  const std::string endian = lower_case(fields.required("endian").value);
  if (endian != "big" && endian != "little") throw fields.wrong("endian", "it must be little or big");
  return endian == "big";
}

std::vector<std::int64_t> sizes_of(const Fields& fields) {
  const auto dimension = parse_int(fields.required("dimension").value);
  if (!dimension || *dimension < 1 || *dimension > kMaxDimension) {
    throw fields.wrong("dimension", cat("it must be 1 to ", kMaxDimension));
  }
  const auto sizes = parse_ints(fields.required("sizes").value);
  if (!sizes || std::ssize(*sizes) != *dimension)
    throw fields.wrong("sizes", cat(*dimension, " whole numbers belong there"));
  return *sizes;
}

std::vector<double> numbers_of(const Fields& fields, const std::string& name, std::size_t count) {
  if (fields.find(name) == nullptr) return {};
  auto numbers = parse_doubles(fields.value(name));
  if (!numbers || numbers->size() != count) throw fields.wrong(name, cat(count, " numbers belong there"));
  return std::move(*numbers);
}

std::vector<std::string> words_of(const Fields& fields, const std::string& name, std::size_t count) {
  if (fields.find(name) == nullptr) return {};
  std::vector<std::string> found;
  for (const std::string_view word : words(fields.value(name))) found.push_back(lower_case(word));
  if (found.size() != count) throw fields.wrong(name, cat(count, " words belong there"));
  return found;
}

/// Returns the texts in quotes, for "\"x\" \"y axis\""; \" stands for a quote inside. Empty if a quote is not closed.
std::vector<std::string> quoted_words(std::string_view text) {
  std::vector<std::string> found;
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escaped = inside && text.substr(i).starts_with("\\\"");
    if (text[i] == '"') {
      inside = !inside;
      if (inside) found.emplace_back();
    } else if (inside) {
      found.back() += text[escaped ? ++i : i];
    }
  }
  if (inside) found.clear();
  return found;
}

/// Returns the names of `count` axes. Names do not affect the placement, so a wrong number of names counts as
/// none.
std::vector<std::string> names_of(const Fields& fields, const std::string& name, std::size_t count) {
  std::vector<std::string> names = quoted_words(fields.value(name));
  if (names.size() != count) names.clear();
  return names;
}

/// Parses vectors such as "(1,0,0) none (0,0.5,0)"; returns nullopt if the text is not such a list.
std::optional<std::vector<std::optional<std::vector<double>>>> parse_vectors(std::string_view text) {
  std::vector<std::optional<std::vector<double>>> vectors;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    if (text.starts_with("none")) {
      vectors.emplace_back();
      text.remove_prefix(4);
      continue;
    }
    const std::size_t close = text.find(')');
    if (text.front() != '(' || close == std::string_view::npos) return std::nullopt;
    std::vector<double> components;
    for (const std::string& part : split(text.substr(1, close - 1), ',')) {
      const auto number = parse_doubles(part);
      if (!number || number->size() != 1) return std::nullopt;
      components.push_back(number->front());
    }
    vectors.emplace_back(std::move(components));
    text.remove_prefix(close + 1);
  }
  return vectors;
}

void read_space(const Fields& fields, NrrdHeader& header) {
  if (fields.find("spacedirections") != nullptr) {
    auto directions = parse_vectors(fields.value("spacedirections"));
    if (!directions || directions->size() != header.sizes.size()) {
      throw fields.wrong("spacedirections",
                         cat(header.sizes.size(), " vectors such as (1,0,0), or none, belong there"));
    }
    header.directions = std::move(*directions);
  }
  if (fields.find("spaceorigin") != nullptr) {
    auto origin = parse_vectors(fields.value("spaceorigin"));
    if (!origin || origin->size() != 1) throw fields.wrong("spaceorigin", "one vector such as (0,0,0) belongs there");
    header.space_origin = origin->front().value_or(std::vector<double>());
  }
  header.space_units = quoted_words(fields.value("spaceunits"));
}

void read_place_of_values(const Fields& fields, NrrdHeader& header) {
  header.data_file = fields.value("datafile");
  if (header.data_file.empty() && fields.ended_by_file()) {
    fields.required("datafile");
    throw fields.wrong("datafile", "a file name belongs there");
  }
  if (fields.find("lineskip") != nullptr) {
    const auto lines = parse_int(fields.value("lineskip"));
    if (!lines || *lines < 0) throw fields.wrong("lineskip", "it must be 0 or more");
    header.line_skip = static_cast<std::uint64_t>(*lines);
  }
  if (fields.find("byteskip") != nullptr) {
    const auto bytes = parse_int(fields.value("byteskip"));
    header.at_end = bytes == -1;
    if (!bytes || *bytes < -1 || (header.at_end && header.gzip)) {
      throw fields.wrong("byteskip", "it must be 0 or more, or -1 for raw values at the file's end");
    }
    header.byte_skip = header.at_end ? 0 : static_cast<std::uint64_t>(*bytes);
  }
}

}  // namespace

NrrdHeader parse_nrrd_header(std::string_view text, bool whole, const std::string& path) {
  const Fields fields(text, whole, path);
  NrrdHeader header;
  header.header_bytes = fields.header_bytes();
  header.type = type_of(fields);
  header.gzip = is_gzip(fields);
  header.big_endian = is_big_endian(fields, header.type);
  header.sizes = sizes_of(fields);
  read_place_of_values(fields, header);
  const std::size_t axes = header.sizes.size();
  header.kinds = words_of(fields, "kinds", axes);
  header.labels = names_of(fields, "labels", axes);
  header.units = names_of(fields, "units", axes);
  header.spacings = numbers_of(fields, "spacings", axes);
  header.axis_mins = numbers_of(fields, "axismins", axes);
  header.axis_maxs = numbers_of(fields, "axismaxs", axes);
  header.centerings = words_of(fields, "centerings", axes);
  read_space(fields, header);
  header.sample_units = fields.value("sampleunits");
  return header;
}

}  // namespace weir
