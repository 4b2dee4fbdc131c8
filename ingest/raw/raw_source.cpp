#include "ingest/raw/raw_source.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/raw/foreign_format.h"
#include "ingest/raw/raw_name.h"
#include "ingest/source/extent.h"
#include "ingest/values/raw_values.h"

namespace weir {
namespace {

/// How the values lie in the file.
struct RawShape {
  Index3 extent;
  ScalarType type = ScalarType::float32;
  bool big_endian = false;
};

Error usage_error(const std::string& path, const Message& what) {
  return Error(ErrorKind::usage, compose(path, ": ", what));
}

Error contradiction(const std::string& path, std::string_view key, std::string_view given, std::string_view named) {
  return usage_error(path, compose(option(key, given), " contradicts the file's name, which says ", named,
                                   "; drop it or rename the file"));
}

std::string dims_text(const Index3& e) { return cat(e.x, ',', e.y, ',', e.z); }

struct PackedBy {
  std::string_view suffix;
  std::string_view magic;
  std::string_view program;
  std::string_view unpack;
};

constexpr std::array<PackedBy, 4> kPackers{{{".gz", "\x1F\x8B", "gzip", "gunzip -k"},
                                            {".xz",
                                             "\xFD"
                                             "7zXZ",
                                             "xz", "xz -dk"},
                                            {".bz2", "BZh", "bzip2", "bunzip2 -k"},
                                            {".zst", "\x28\xB5\x2F\xFD", "zstd", "zstd -d"}}};

// Throws if the name has a packer's suffix and the file begins with this packer's magic bytes.
void refuse_packed(InputFile& file) {
  for (const PackedBy& by : kPackers) {
    if (!lower_case(file.path()).ends_with(by.suffix) || file.size() < by.magic.size()) continue;
    std::string head(by.magic.size(), '\0');
    file.read_buffered(0, std::as_writable_bytes(std::span(head)), ReadPath::through);
    if (head == by.magic) {
      throw input_error(file.path(), cat("is packed by ", by.program, "; unpack it first, with ", by.unpack));
    }
  }
}

// Refuses numpy files by their name, because their bytes begin with numpy's header.
void refuse_numpy(const std::string& path) {
  if (const std::string lower = lower_case(path); !lower.ends_with(".npy") && !lower.ends_with(".npz")) return;
  throw input_error(
      path, "is an array of numpy, which weir's module for Python converts: weir.convert(numpy.load(PATH), OUTPUT)");
}

RawShape resolve_shape(InputFile& file, const SourceOptions& options) {
  const std::string& path = file.path();
  const auto name = parse_raw_name(path);
  RawShape shape;
  if (name && options.extent && *options.extent != name->extent) {
    throw contradiction(path, "dims", dims_text(*options.extent), extent_text(name->extent));
  }
  if (!name && !options.extent) {
    refuse_numpy(path);
    refuse_foreign_format(file);
    throw usage_error(path, compose("extent unknown; give ", option("dims", "X,Y,Z"), " and ", option("type"),
                                    " or name the file NAME_XxYxZ_TYPE.raw"));
  }
  shape.extent = options.extent ? *options.extent : name->extent;

  const std::optional<ScalarType> named_type = name ? name->type : std::nullopt;
  if (named_type && options.type && *options.type != *named_type) {
    throw contradiction(path, "type", scalar_name(*options.type), scalar_name(*named_type));
  }
  if (!named_type && !options.type) {
    const std::string found = name ? cat("unknown type '", name->type_text, "' in the file's name") : "type unknown";
    throw usage_error(path, compose(found, "; give ", option("type"), " with one of ", scalar_names()));
  }
  shape.type = options.type ? *options.type : *named_type;

  // A name without "be" says nothing about the byte order: published little-endian and big-endian files both lack it.
  const bool named_big = name && name->type && name->big_endian;
  if (named_big && options.big_endian == false) throw contradiction(path, "endian", "little", name->type_text);
  shape.big_endian = options.big_endian.value_or(named_big);
  return shape;
}

void check_size(const InputFile& file, const RawShape& shape, std::uint64_t offset) {
  const std::uint64_t values = checked_volume_bytes(shape.extent, scalar_bytes(shape.type), file.path());
  const std::uint64_t expected = offset + std::min(values, ~offset);
  if (expected == file.size()) return;
  const bool too_short = expected > file.size();
  const std::uint64_t difference = too_short ? expected - file.size() : file.size() - expected;
  throw Error(ErrorKind::input,
              compose(file.path(), ": ", difference, difference == 1 ? " byte too " : " bytes too ",
                      too_short ? "short" : "long", ": ", extent_text(shape.extent), ' ', scalar_name(shape.type),
                      " after an offset of ", offset, " needs ", expected, " bytes, the file has ", file.size(),
                      "; check ", option("dims"), ", ", option("type"), " and ", option("offset")));
}

}  // namespace

std::unique_ptr<VolumeSource> open_raw(const std::string& path, const SourceOptions& options) {
  auto file = std::make_unique<InputFile>(path, options.direct_io);
  refuse_packed(*file);
  const RawShape shape = resolve_shape(*file, options);
  RawLayout layout{options.offset.value_or(0), shape.type, shape.big_endian, {}};
  check_size(*file, shape, layout.offset);
  options.complete(layout.mapping);
  SourceInfo info;
  info.path = path;
  info.format = "raw";
  info.extent = shape.extent;
  return make_raw_values(std::move(file), layout, std::move(info));
}

}  // namespace weir
