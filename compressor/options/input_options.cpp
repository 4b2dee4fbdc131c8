// The table of options about the input that the input itself does not tell.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "compressor/options/conversion_request.h"
#include "format/base/scalar_type.h"

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

std::array<double, 3> read_spacing(const OptionRow& row, const std::string& text) {
  const std::array<double, 3> spacing = read_triple(row, text);
  for (const double s : spacing) {
    if (!(s > 0) || !std::isfinite(s)) {
      throw wrong_option(row.key, text, "x,y,z, three finite numbers above 0 in world units");
    }
  }
  return spacing;
}

void read_roi(const OptionRow& row, const std::string& text, Request& request) {
  const auto bad = [&](std::string_view why) {
    return wrong_option(row.key, text, cat("x0:x1,y0:y1,z0:z1, whole numbers, x0 inclusive, x1 exclusive", why));
  };
  const auto read_end = [&](const std::string& end) -> std::optional<std::int64_t> {
    if (end.empty()) return std::nullopt;
    const auto number = parse_int(end);
    if (!number) throw bad("");
    return number;
  };
  const std::vector<std::string> axes = split(text, ',');
  if (axes.size() != 3) throw bad("");
  VolumeRegion region;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<std::string> range = split(axes[axis], ':');
    if (range.size() != 2) throw bad("");
    const auto first = region.first.at(axis) = read_end(range[0]);
    const auto end = region.end.at(axis) = read_end(range[1]);
    const bool comparable = first && end && (*first < 0) == (*end < 0);  // counted from the same end
    if (comparable && *first >= *end) throw bad(", with every end above its start");
  }
  request.source.roi = region;
}

constexpr std::int64_t kMostGhosts = std::numeric_limits<std::int32_t>::max();  // voxels

void read_ghost(const OptionRow& row, const std::string& text, Request& request) {
  std::vector<std::int64_t> layers;
  const std::vector<std::string> parts = split(text, ',');
  for (const std::string& part : parts) {
    if (const auto number = parse_int(part); number && *number >= 0 && *number <= kMostGhosts)
      layers.push_back(*number);
  }
  if (layers.size() != parts.size() || (layers.size() != 1 && layers.size() != 3)) {
    throw wrong_option(row.key, text, "N or X,Y,Z, whole numbers of voxels from 0 on");
  }
  if (layers.size() == 1) layers.resize(3, layers.front());
  VolumeRegion region;
  region.ghost = {layers[0], layers[1], layers[2]};
  request.source.roi = region;
}

void read_type(const OptionRow& row, const std::string& text, Request& request) {
  const auto [name, big_endian] = split_byte_order(text);
  request.source.type = parse_scalar(name);
  if (!request.source.type) {
    throw wrong_option(row.key, text,
                       cat("one of ", scalar_names(), ", or ", scalar_aliases(),
                           ", where < or > before the name says the byte order"));
  }
  if (big_endian) request.source.big_endian = big_endian;
}

// Reads the byte order. The row of `type` comes first, and `type` may already have given the order.
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
  std::vector<AxisChoice> choices;
  for (const std::string& part : split(text, ',')) {
    const std::optional<AxisChoice> choice = parse_axis_choice(part);
    if (!choice) {
      throw wrong_option(row.key, text,
                         "i,j,..., whole numbers, below 0 from the end, FROM:TO or * for several, or AXIS=i");
    }
    choices.push_back(*choice);
  }
  if (std::ranges::all_of(choices, &AxisChoice::plain)) {
    for (const AxisChoice& choice : choices) request.source.index.push_back(*choice.first);
  } else {
    request.source.index_choices = std::move(choices);
  }
}

void read_component(const OptionRow& row, const std::string& text, Request& request) {
  request.source.component = parse_component(text);
  if (!request.source.component) {
    throw wrong_option(row.key, text, cat("x, y, z, magnitude or a whole number from 0 to ", kMostComponents - 1));
  }
}

void read_magnitude(const OptionRow& row, const std::string& text, Request& request) {
  request.source.magnitude = split(text, ',');
  const bool named = std::ranges::none_of(request.source.magnitude, &std::string::empty);
  if (!named || request.source.magnitude.size() < 2) {
    throw wrong_option(row.key, text, "the names of two datasets or more, u,v,w");
  }
}

void read_level(const OptionRow& row, const std::string& text, Request& request) {
  constexpr std::int64_t kMost = 99;
  request.source.level = parse_int(text);
  if (!request.source.level || *request.source.level < 0 || *request.source.level > kMost) {
    throw wrong_option(row.key, text, cat("a whole number from 0, the coarsest level, to ", kMost));
  }
}

void read_missing(const OptionRow& row, const std::string& text, Request& request) {
  request.source.missing = parse_stored_value(text);
  if (!request.source.missing) throw wrong_option(row.key, text, "a number or nan");
}

void read_missing_policy(const OptionRow& row, const std::string& text, Request& request) {
  request.conversion.missing =
      std::array{MissingPolicy::automatic, MissingPolicy::error, MissingPolicy::background, MissingPolicy::keep}.at(
          read_choice(row, text));
  request.source.keeps_missing = request.conversion.missing == MissingPolicy::keep;
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
      .help = "uint8, int8, uint16, int16, uint32, int32, uint64, int64, float16, bfloat16, float32 or float64; "
              "float, double, f4, <f4 and the like"},
     read_type},
    {{.key = "endian", .argument = "little|big", .standard = "the name's, else little", .help = "byte order"},
     read_endian},
    {{.key = "offset", .argument = "BYTES", .unit = "bytes", .standard = "0", .help = "bytes before the first value"},
     read_offset},
    {{.key = "dataset",
      .argument = "NAME",
      .standard = "the only one",
      .help = "dataset or grid of a file that holds several; weir inspect lists them",
      .of_several = ". For several volumes it may be given several times, or be a pattern, '*' or '/step_%d/rho'",
      .several = true},
     [](const OptionRow&, const std::string& text, Request& r) { r.source.dataset = text; }},
    {{.key = "index",
      .argument = "i,j,...",
      .help = "position on each leading axis of an array of more than three, or AXIS=i; below 0 from the end",
      .of_several = "; FROM:TO or * for a volume of each"},
     read_index},
    {{.key = "component",
      .argument = "N|x|y|z|magnitude",
      .help = "of vectors or tensors in an HDF5, Zarr, VTK or OpenVDB file: the component with this position, or the "
              "length of the vector"},
     read_component},
    {{.key = "magnitude",
      .argument = "U,V,W",
      .help = "the length of the vectors whose components are these datasets of the file, on the same voxels",
      .excludes = "dataset,component,stack"},
     read_magnitude},
    {{.key = "level",
      .argument = "N",
      .standard = "the finest",
      .help = "of an AMReX plotfile: the finest level of refinement that is read, 0 the coarsest; the volume has its "
              "cells"},
     read_level},
    {{.key = "levels",
      .argument = "composite|separate",
      .standard = "composite",
      .help = "of an AMReX plotfile: composite, one file with the cells of the finest level; separate, a file of each "
              "level, NAME_level_N.nvdb with N from 0, the finest, on, in which cells that a finer level has are "
              "inactive. A budget is that of each file"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.source.levels = std::array{Levels::composite, Levels::separate}.at(read_choice(row, text));
     }},
    {{.key = "upsample",
      .argument = "constant|linear",
      .standard = "constant",
      .help = "of an AMReX plotfile, where only coarser levels have values: constant, that of the coarse cell, or "
              "linear, between the centres of coarse cells"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.source.upsampling = std::array{Upsampling::constant, Upsampling::linear}.at(read_choice(row, text));
     }},
    {{.key = "missing-chunks",
      .argument = "fill|error",
      .standard = "fill",
      .help =
          "of a Zarr array or an HDF5 dataset, what chunks that are not stored read as: fill, its fill value; error: "
          "a volume that lacks a chunk is refused"},
     [](const OptionRow& row, const std::string& text, Request& r) {
       r.source.missing_chunks = std::array{MissingChunks::fill, MissingChunks::error}.at(read_choice(row, text));
     }},
    {{.key = "stack", .help = "the input is a pattern, 'plane_%05d.raw': one volume from many files along z"},
     [](const OptionRow& row, const std::string& text, Request& r) { r.source.stack = read_flag(row, text); }},
    {{.key = "spacing",
      .argument = "x,y,z",
      .unit = "world units",
      .standard = "the file's, else 1,1,1",
      .help = "world units per voxel"},
     [](const OptionRow& row, const std::string& text, Request& r) { r.source.spacing = read_spacing(row, text); }},
    {{.key = "origin",
      .argument = "x,y,z",
      .unit = "world units",
      .standard = "the file's, else 0,0,0",
      .help = "world position of the centre of voxel 0,0,0"},
     [](const OptionRow& row, const std::string& text, Request& r) { r.source.origin = read_triple(row, text); }},
    {{.key = "missing",
      .argument = "VALUE",
      .unit = "stored values",
      .help = "a stored value that stands for \"no data\", besides what the file says"},
     read_missing},
    {{.key = "missing-policy",
      .argument = "auto|error|background|keep",
      .standard = "auto",
      .help =
          "what becomes of voxels that hold no data, which --missing or the file's _FillValue or missing_value marks. "
          "error: they are refused. background: they get the background. keep: they keep the fill value, as data. "
          "auto: as --nonfinite says, whose default is error; with --nonfinite keep they become NaN; in a picture of a "
          "source, background"},
     read_missing_policy},
    {{.key = "roi",
      .argument = "x0:x1,y0:y1,z0:z1",
      .unit = "voxels",
      .standard = "the whole volume",
      .help =
          "only this box of voxels, x0 inclusive, x1 exclusive, by the file's own indices, which count from the lowest "
          "coordinate where coordinates fall, and in AMReX from the domain's lower corner; an end left out is the "
          "volume's, one below 0 counts from its end unless the file's indices begin below 0",
      .group = "region"},
     read_roi},
    {{.key = "ghost",
      .argument = "N|X,Y,Z",
      .unit = "voxels",
      .standard = "0",
      .help = "leave out so many layers of ghost cells at both ends of each axis",
      .group = "region"},
     read_ghost},
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
  constexpr double kFewestTooMany = 0x1p60;  // voxels: their bytes in float64 are no 64-bit number
  const std::vector<std::string> parts = split(text, text.find('x') == std::string::npos ? ',' : 'x');
  std::vector<std::int64_t> dims;
  for (const std::string& part : parts) {
    if (const auto number = parse_int(part)) dims.push_back(*number);
  }
  if (dims.size() != 3 || parts.size() != 3) throw wrong_option(key, text, "X,Y,Z, three whole numbers of voxels");
  if (!std::ranges::all_of(dims, [](std::int64_t n) { return n >= 1 && n <= kMost; })) {
    throw wrong_option(key, text, cat("X,Y,Z, three whole numbers of voxels, each from 1 to ", kMost));
  }
  const double voxels = static_cast<double>(dims[0]) * static_cast<double>(dims[1]) * static_cast<double>(dims[2]);
  if (!(voxels < kFewestTooMany)) {
    throw wrong_option(key, text, "X,Y,Z, three whole numbers of voxels, with fewer than 2^60 voxels together");
  }
  return {dims[0], dims[1], dims[2]};
}

}  // namespace weir
