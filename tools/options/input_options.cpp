#include "tools/options/input_options.h"

#include <CLI/CLI.hpp>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/scalar_type.h"
#include "format/base/text.h"
#include "ingest/series.h"

namespace weir {
namespace {

Error bad_option(std::string_view option, std::string_view text, std::string_view form) {
  return {ErrorKind::usage, cat(option, " is \"", text, "\", it must be ", form)};
}

std::array<double, 3> parse_triple(std::string_view option, const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  std::array<double, 3> triple{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto number = parse_double(parts[i]);
    if (!number || parts.size() != 3) throw bad_option(option, text, "x,y,z, three numbers in world units");
    triple.at(i) = *number;
  }
  return triple;
}

Box parse_roi(const std::string& text) {
  const auto bad = [&](std::string_view why) {
    return bad_option("--roi", text, cat("x0:x1,y0:y1,z0:z1, whole numbers, half open", why));
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
  return box;
}

ScalarType parse_type(const std::string& text) {
  const auto type = parse_scalar(text);
  if (!type) throw bad_option("--type", text, cat("one of ", scalar_names()));
  return *type;
}

std::uint64_t parse_offset(const std::string& text) {
  const auto bytes = parse_bytes(text);
  if (!bytes) throw bad_option("--offset", text, "a number of bytes, like 352 or 4KiB");
  return *bytes;
}

std::vector<std::int64_t> parse_index(const std::string& text) {
  std::vector<std::int64_t> index;
  for (const std::string& part : split(text, ',')) {
    const auto number = part == "*" ? kEveryIndex : parse_int(part);
    if (!number || (*number < 0 && part != "*")) {
      throw bad_option("--index", text, "i,j,..., whole numbers from 0 on, or * for each of them");
    }
    index.push_back(*number);
  }
  return index;
}

StoredValue parse_missing(const std::string& text) {
  const auto value = parse_stored_value(text);
  if (!value) throw bad_option("--missing", text, "a number or nan");
  return *value;
}

DirectIo parse_direct_io(const std::string& text) {
  if (text == "auto") return DirectIo::automatic;
  if (text == "on") return DirectIo::on;
  if (text == "off") return DirectIo::off;
  throw bad_option("--direct-io", text, "auto, on or off");
}

bool parse_big_endian(const std::string& text) {
  if (text != "little" && text != "big") throw bad_option("--endian", text, "little or big");
  return text == "big";
}

}  // namespace

void add_input_options(CLI::App& command, InputArguments& arguments) {
  const auto add = [&command](const std::string& name, std::string& text, const std::string& form,
                              const std::string& help) {
    command.add_option(name, text, help)->type_name(form)->group("Input");
  };
  add("--dims", arguments.dims, "X,Y,Z", "voxels, x fastest; unneeded for NAME_XxYxZ_TYPE.raw");
  add("--type", arguments.type, "TYPE", scalar_names());
  add("--endian", arguments.endian, "little|big", "byte order; default: the name's, else little");
  add("--offset", arguments.offset, "BYTES", "bytes before the first value; default 0");
  add("--dataset", arguments.dataset, "NAME", "dataset or grid of a file that holds several; weir inspect lists them");
  add("--index", arguments.index, "i,j,...",
      "position on each leading axis of an array of more than three; * for a volume of each");
  command
      .add_flag("--stack", arguments.stack,
                "the input is a pattern, 'plane_%05d.raw': one volume from many files along z")
      ->group("Input");
  add("--spacing", arguments.spacing, "x,y,z", "world units per voxel; default: the file's, else 1,1,1");
  add("--origin", arguments.origin, "x,y,z", "world position of voxel 0,0,0; default: the file's, else 0,0,0");
  add("--missing", arguments.missing, "VALUE",
      "a stored value that stands for \"no data\", besides what the file says");
  add("--roi", arguments.roi, "x0:x1,y0:y1,z0:z1", "only this box of voxels, half open");
  add("--direct-io", arguments.direct_io, "auto|on|off", "read past the page cache; default auto: what is not in it");
}

std::string given_input_option(const InputArguments& arguments) {
  const std::array<std::pair<std::string_view, const std::string&>, 11> options{{{"--dims", arguments.dims},
                                                                                 {"--type", arguments.type},
                                                                                 {"--endian", arguments.endian},
                                                                                 {"--offset", arguments.offset},
                                                                                 {"--dataset", arguments.dataset},
                                                                                 {"--index", arguments.index},
                                                                                 {"--spacing", arguments.spacing},
                                                                                 {"--origin", arguments.origin},
                                                                                 {"--missing", arguments.missing},
                                                                                 {"--roi", arguments.roi},
                                                                                 {"--direct-io", arguments.direct_io}}};
  for (const auto& [name, text] : options) {
    if (!text.empty()) return std::string(name);
  }
  return arguments.stack ? "--stack" : "";
}

SourceOptions parse_input(const InputArguments& arguments) {
  SourceOptions options;
  if (!arguments.dims.empty()) options.extent = parse_dims("--dims", arguments.dims);
  if (!arguments.type.empty()) options.type = parse_type(arguments.type);
  if (!arguments.endian.empty()) options.big_endian = parse_big_endian(arguments.endian);
  if (!arguments.offset.empty()) options.offset = parse_offset(arguments.offset);
  options.stack = arguments.stack;
  options.dataset = arguments.dataset;
  if (!arguments.index.empty()) options.index = parse_index(arguments.index);
  if (!arguments.missing.empty()) options.missing = parse_missing(arguments.missing);
  if (!arguments.spacing.empty()) options.spacing = parse_triple("--spacing", arguments.spacing);
  if (!arguments.origin.empty()) options.origin = parse_triple("--origin", arguments.origin);
  if (!arguments.direct_io.empty()) options.direct_io = parse_direct_io(arguments.direct_io);
  if (!arguments.roi.empty()) options.roi = parse_roi(arguments.roi);
  return options;
}

Index3 parse_dims(const std::string& option, const std::string& text) {
  std::vector<std::int64_t> dims;
  for (const std::string& part : split(text, ',')) {
    if (const auto number = parse_int(part)) dims.push_back(*number);
  }
  if (dims.size() != 3 || split(text, ',').size() != 3) {
    throw bad_option(option, text, "X,Y,Z, three whole numbers of voxels");
  }
  return {dims[0], dims[1], dims[2]};
}

}  // namespace weir
