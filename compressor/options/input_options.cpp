// What an input does not say itself.
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "compressor/options/conversion_request.h"
#include "format/base/scalar_type.h"
#include "ingest/series.h"

namespace weir {
namespace {

using Request = ConversionRequest;

std::array<double, 3> read_triple(const OptionRow& row, const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  std::array<double, 3> triple{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto number = parse_double(parts[i]);
    if (!number || parts.size() != 3) throw wrong_option(row.key, text, "x,y,z, three numbers in world units");
    triple.at(i) = *number;
  }
  return triple;
}

void read_roi(const OptionRow& row, const std::string& text, Request& request) {
  const auto bad = [&](std::string_view why) {
    return wrong_option(row.key, text, cat("x0:x1,y0:y1,z0:z1, whole numbers, half open", why));
  };
  std::vector<std::int64_t> ends;
  for (const std::string& axis : split(text, ',')) {
    const std::vector<std::string> range = split(axis, ':');
    if (range.size() != 2) throw bad("");
    for (const std::string& end : range) {
      const auto number = parse_int(end);
      if (!number) throw bad("");
      ends.push_back(*number);
    }
  }
  if (ends.size() != 6) throw bad("");
  const Box box{{ends[0], ends[2], ends[4]}, {ends[1], ends[3], ends[5]}};
  if (box.empty()) throw bad(", with every end above its start");
  request.source.roi = box;
}

// weir's names, C's, and numpy's with or without a byte order.
std::optional<ScalarType> parse_type_of_any(std::string_view name) {
  if (const std::optional<ScalarType> type = parse_scalar(name)) return type;
  constexpr std::array<std::pair<std::string_view, ScalarType>, 13> kOthers{{{"float", ScalarType::float32},
                                                                             {"double", ScalarType::float64},
                                                                             {"u1", ScalarType::uint8},
                                                                             {"i1", ScalarType::int8},
                                                                             {"u2", ScalarType::uint16},
                                                                             {"i2", ScalarType::int16},
                                                                             {"u4", ScalarType::uint32},
                                                                             {"i4", ScalarType::int32},
                                                                             {"u8", ScalarType::uint64},
                                                                             {"i8", ScalarType::int64},
                                                                             {"f2", ScalarType::float16},
                                                                             {"f4", ScalarType::float32},
                                                                             {"f8", ScalarType::float64}}};
  if (!name.empty() && std::string_view("<>|=").find(name.front()) != std::string_view::npos) name.remove_prefix(1);
  for (const auto& [other, type] : kOthers) {
    if (name == other) return type;
  }
  return std::nullopt;
}

void read_type(const OptionRow& row, const std::string& text, Request& request) {
  request.source.type = parse_type_of_any(text);
  if (!request.source.type) throw wrong_option(row.key, text, cat("one of ", scalar_names()));
  if (text.front() == '<' || text.front() == '>') request.source.big_endian = text.front() == '>';
}

// After `type`, whose row comes first and which may have said it.
void read_endian(const OptionRow& row, const std::string& text, Request& request) {
  const bool big = read_choice(row, text) == 1;
  if (request.source.big_endian.value_or(big) != big) {
    throw usage_error(compose(option(row.key), " is \"", text, "\", and the byte order that ", option("type"),
                              " names is the other one"));
  }
  request.source.big_endian = big;
}

void read_offset(const OptionRow& row, const std::string& text, Request& request) {
  request.source.offset = parse_bytes(text);
  if (!request.source.offset) throw wrong_option(row.key, text, "a number of bytes, like 352 or 4KiB");
}

void read_index(const OptionRow& row, const std::string& text, Request& request) {
  for (const std::string& part : split(text, ',')) {
    const auto number = part == "*" ? kEveryIndex : parse_int(part);
    if (!number || (*number < 0 && part != "*")) {
      throw wrong_option(row.key, text, "i,j,..., whole numbers from 0 on, or * for each of them");
    }
    request.source.index.push_back(*number);
  }
}

void read_missing(const OptionRow& row, const std::string& text, Request& request) {
  request.source.missing = parse_stored_value(text);
  if (!request.source.missing) throw wrong_option(row.key, text, "a number or nan");
}

void read_direct_io(const OptionRow& row, const std::string& text, Request& request) {
  request.source.direct_io = std::array{DirectIo::automatic, DirectIo::on, DirectIo::off}.at(read_choice(row, text));
}

constexpr ConversionOption kInputOptions[] = {
    {{.key = "dims",
      .argument = "X,Y,Z",
      .unit = "voxels",
      .help = "voxels, x fastest; unneeded for NAME_XxYxZ_TYPE.raw"},
     [](const OptionRow& row, const std::string& text, Request& r) { r.source.extent = read_dims(row.key, text); }},
    {{.key = "type",
      .argument = "TYPE",
      .standard = "the name's",
      .help = "uint8, int8, uint16, int16, uint32, int32, uint64, int64, float16, float32 or float64; float, double, "
              "f4, <f4 and the like"},
     read_type},
    {{.key = "endian", .argument = "little|big", .standard = "the name's, else little", .help = "byte order"},
     read_endian},
    {{.key = "offset", .argument = "BYTES", .unit = "bytes", .standard = "0", .help = "bytes before the first value"},
     read_offset},
    {{.key = "dataset",
      .argument = "NAME",
      .standard = "the only one",
      .help = "dataset or grid of a file that holds several; weir inspect lists them"},
     [](const OptionRow&, const std::string& text, Request& r) { r.source.dataset = text; }},
    {{.key = "index",
      .argument = "i,j,...",
      .help = "position on each leading axis of an array of more than three; * for a volume of each"},
     read_index},
    {{.key = "stack", .help = "the input is a pattern, 'plane_%05d.raw': one volume from many files along z"},
     [](const OptionRow& row, const std::string& text, Request& r) { r.source.stack = read_flag(row, text); }},
    {{.key = "spacing",
      .argument = "x,y,z",
      .unit = "world units",
      .standard = "the file's, else 1,1,1",
      .help = "world units per voxel"},
     [](const OptionRow& row, const std::string& text, Request& r) { r.source.spacing = read_triple(row, text); }},
    {{.key = "origin",
      .argument = "x,y,z",
      .unit = "world units",
      .standard = "the file's, else 0,0,0",
      .help = "world position of voxel 0,0,0"},
     [](const OptionRow& row, const std::string& text, Request& r) { r.source.origin = read_triple(row, text); }},
    {{.key = "missing",
      .argument = "VALUE",
      .unit = "stored values",
      .help = "a stored value that stands for \"no data\", besides what the file says"},
     read_missing},
    {{.key = "roi",
      .argument = "x0:x1,y0:y1,z0:z1",
      .unit = "voxels",
      .standard = "the whole volume",
      .help = "only this box of voxels, half open"},
     read_roi},
    {{.key = "direct-io",
      .argument = "auto|on|off",
      .standard = "auto",
      .help = "read past the page cache; auto: what is not in it"},
     read_direct_io},
};

}  // namespace

std::span<const ConversionOption> input_options() { return kInputOptions; }

Index3 read_dims(std::string_view key, const std::string& text) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  const std::vector<std::string> parts = split(text, text.find('x') == std::string::npos ? ',' : 'x');
  std::vector<std::int64_t> dims;
  for (const std::string& part : parts) {
    if (const auto number = parse_int(part)) dims.push_back(*number);
  }
  if (dims.size() != 3 || parts.size() != 3) throw wrong_option(key, text, "X,Y,Z, three whole numbers of voxels");
  if (!std::ranges::all_of(dims, [](std::int64_t n) { return n >= 1 && n <= kMost; })) {
    throw wrong_option(key, text, cat("X,Y,Z, three whole numbers of voxels, each from 1 to ", kMost));
  }
  return {dims[0], dims[1], dims[2]};
}

}  // namespace weir
