#include "ingest/meta_image/meta_image_header.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

constexpr std::int64_t kMaxDimensions = 10;  ///< MetaIO's limit

using TypeName = std::pair<std::string_view, ScalarType>;
// Widths are MetaIO's own: MET_LONG is four bytes on every machine.
constexpr std::array<TypeName, 12> kMetaTypes{{{"MET_CHAR", ScalarType::int8},
                                               {"MET_UCHAR", ScalarType::uint8},
                                               {"MET_SHORT", ScalarType::int16},
                                               {"MET_USHORT", ScalarType::uint16},
                                               {"MET_INT", ScalarType::int32},
                                               {"MET_UINT", ScalarType::uint32},
                                               {"MET_LONG", ScalarType::int32},
                                               {"MET_ULONG", ScalarType::uint32},
                                               {"MET_LONG_LONG", ScalarType::int64},
                                               {"MET_ULONG_LONG", ScalarType::uint64},
                                               {"MET_FLOAT", ScalarType::float32},
                                               {"MET_DOUBLE", ScalarType::float64}}};

struct Entry {
  std::string_view value;
  std::size_t line = 0;
};

/// Parses "Key = Value"; returns nullopt if the line has no '='.
std::optional<std::pair<std::string_view, std::string_view>> key_and_value(std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  return std::pair(trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1)));
}

/// The most keys: as many as fit in a header without frames.
constexpr std::size_t kMostKeys = kHeaderLimit / 8;

/// The entries of a header up to ElementDataFile, which ends it.
class Entries {
 public:
  Entries(std::string_view text, bool whole, const std::string& path) : path_(path) {
    LineReader lines(text);
    while (const auto line = lines.next()) {
      if (lines.open_ended() && !whole) break;
      if (trimmed(*line).empty()) continue;
      const auto entry = key_and_value(*line);
      if (!entry) {
        throw Error(ErrorKind::input, cat(path, ": line ", lines.number(), " of its header is ", in_quotes(*line),
                                          ", not 'Key = Value'"));
      }
      if (entry->first.starts_with(kFrameKey)) continue;
      if (entries_.size() == kMostKeys) {
        throw Error(ErrorKind::input,
                    cat(path, ": its header has more than ", kMostKeys, " keys besides those of frames"));
      }
      if (!entries_.emplace(entry->first, Entry{entry->second, lines.number()}).second) {
        throw Error(ErrorKind::input, cat(path, ": line ", lines.number(), " of its header gives ",
                                          in_quotes(entry->first), " a second time"));
      }
      if (entry->first == "ElementDataFile") {
        header_bytes_ = lines.position();
        return;
      }
    }
    throw Error(ErrorKind::input,
                whole ? cat(path, ": its header has no ElementDataFile, with which it must end; the file is cut")
                      : cat(path, ": its header does not end within ", text.size(), " bytes"));
  }

  std::size_t header_bytes() const { return header_bytes_; }
  bool has(std::string_view key) const { return entries_.contains(key); }
  const Entry& required(std::string_view key) const {
    const auto found = entries_.find(key);
    if (found == entries_.end()) throw Error(ErrorKind::input, cat(path_, ": its header has no ", key));
    return found->second;
  }
  Error wrong(std::string_view key, const Message& expected) const {
    const Entry& entry = required(key);
    return Error(ErrorKind::input,
                 compose(path_, ": line ", entry.line, ": ", key, " is ", in_quotes(entry.value), "; ", expected));
  }

  /// Returns the key's value as a flag. MetaIO treats every value that begins with T, t or 1 as true.
  bool flag(std::string_view key) const {
    if (!has(key)) return false;
    const std::string_view value = required(key).value;
    return !value.empty() && (value[0] == 'T' || value[0] == 't' || value[0] == '1');
  }
  std::int64_t integer(std::string_view key, std::int64_t absent) const {
    if (!has(key)) return absent;
    const auto value = parse_int(required(key).value);
    if (!value) throw wrong(key, "a whole number belongs there");
    return *value;
  }
  double number(std::string_view key, double absent) const {
    if (!has(key)) return absent;
    const auto value = parse_double(required(key).value);
    if (!value || !std::isfinite(*value)) throw wrong(key, "a number belongs there");
    return *value;
  }
  /// Returns the numbers of the first of `keys` that the header has; empty if it has none.
  std::vector<double> numbers(std::initializer_list<std::string_view> keys, std::size_t count) const {
    for (const std::string_view key : keys) {
      if (!has(key)) continue;
      auto values = parse_doubles(required(key).value);
      if (!values || values->size() != count) throw wrong(key, cat(count, " numbers belong there"));
      return std::move(*values);
    }
    return {};
  }

 private:
  const std::string& path_;
  std::map<std::string_view, Entry> entries_;
  std::size_t header_bytes_ = 0;
};

ScalarType type_of(const Entries& entries) {
  const std::string_view name = entries.required("ElementType").value;
  const auto* const found =
      std::find_if(kMetaTypes.begin(), kMetaTypes.end(), [&](const TypeName& type) { return type.first == name; });
  if (found == kMetaTypes.end())
    throw entries.wrong("ElementType", "MET_CHAR to MET_DOUBLE can be read, one value a voxel");
  return found->second;
}

std::vector<std::int64_t> dim_size_of(const Entries& entries) {
  const std::int64_t dimensions = entries.integer("NDims", 0);
  if (dimensions < 1 || dimensions > kMaxDimensions) {
    throw entries.wrong("NDims", cat("it must be 1 to ", kMaxDimensions));
  }
  const auto sizes = parse_ints(entries.required("DimSize").value);
  if (!sizes || std::ssize(*sizes) != dimensions) {
    throw entries.wrong("DimSize", cat(dimensions, " whole numbers belong there"));
  }
  return *sizes;
}

void refuse_what_is_not_read(const Entries& entries) {
  if (entries.has("ObjectType") && entries.required("ObjectType").value != "Image") {
    throw entries.wrong("ObjectType", "only Image can be read");
  }
  if (entries.integer("ElementNumberOfChannels", 1) != 1) {
    throw entries.wrong("ElementNumberOfChannels", "one value a voxel can be read; write each channel to a file");
  }
  if (entries.has("BinaryData") && !entries.flag("BinaryData")) {
    throw entries.wrong("BinaryData", "values as text cannot be read; write the image with BinaryData = True");
  }
}

void read_place_of_values(const Entries& entries, MetaImageHeader& header) {
  header.compressed = entries.flag("CompressedData");
  const std::int64_t compressed_bytes = entries.integer("CompressedDataSize", 0);
  if (compressed_bytes < 0) throw entries.wrong("CompressedDataSize", "it must be 0 or more");
  header.compressed_bytes = static_cast<std::uint64_t>(compressed_bytes);

  const std::int64_t header_size = entries.integer("HeaderSize", 0);
  header.at_end = header_size == -1;
  if (header_size < -1 || (header.at_end && header.compressed)) {
    throw entries.wrong("HeaderSize", "it must be 0 or more, or -1 for uncompressed values at the file's end");
  }
  header.header_size = header.at_end ? 0 : static_cast<std::uint64_t>(header_size);

  const std::string_view name = entries.required("ElementDataFile").value;
  if (name.empty()) throw entries.wrong("ElementDataFile", "LOCAL or a file name belongs there");
  if (name.starts_with("LIST") || name.find('%') != std::string_view::npos) {
    throw entries.wrong(
        "ElementDataFile",
        compose("one file for all values can be read; stack the files of a list with ", option("stack")));
  }
  if (lower_case(name) != "local") header.data_file = name;
}

}  // namespace

MetaImageHeader parse_meta_image_header(std::string_view text, bool whole, const std::string& path) {
  const Entries entries(text, whole, path);
  refuse_what_is_not_read(entries);
  MetaImageHeader header;
  header.header_bytes = entries.header_bytes();
  header.type = type_of(entries);
  header.big_endian = entries.flag("BinaryDataByteOrderMSB") || entries.flag("ElementByteOrderMSB");
  header.dim_size = dim_size_of(entries);
  read_place_of_values(entries, header);
  const std::size_t axes = header.dim_size.size();
  header.spacing = entries.numbers({"ElementSpacing", "ElementSize"}, axes);
  header.origin = entries.numbers({"Offset", "Origin", "Position"}, axes);
  header.transform = entries.numbers({"TransformMatrix", "Rotation", "Orientation"}, axes * axes);
  // MetaIO writes "?" for unknown units.
  if (entries.has("DistanceUnits") && entries.required("DistanceUnits").value != "?") {
    header.distance_units = entries.required("DistanceUnits").value;
  }
  header.slope = entries.number("ElementToIntensityFunctionSlope", 1);
  if (header.slope == 0) throw entries.wrong("ElementToIntensityFunctionSlope", "it must not be 0");
  header.offset = entries.number("ElementToIntensityFunctionOffset", 0);
  return header;
}

}  // namespace weir
