#include "ingest/raw_source.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string_view>

#include "format/error.h"
#include "format/text.h"
#include "ingest/box_pieces.h"
#include "ingest/convert_values.h"
#include "ingest/extent.h"
#include "ingest/for_pieces.h"
#include "ingest/raw_name.h"
#include "ingest/staging.h"

namespace weir {
namespace {

/// Boxes below this many bytes of the file per thread are not worth another thread.
constexpr std::int64_t kBytesPerThread = 256 * 1024;

/// How the values lie in the file.
struct RawShape {
  Index3 extent;
  ScalarType type = ScalarType::float32;
  bool big_endian = false;
};

Error usage_error(const std::string& path, const std::string& what) {
  return Error(ErrorKind::usage, cat(path, ": ", what));
}

Error contradiction(const std::string& path, std::string_view option, std::string_view given, std::string_view named) {
  return usage_error(path, cat(option, ' ', given, " contradicts the file's name, which says ", named,
                               "; drop it or rename the file"));
}

std::string dims_text(const Index3& e) { return cat(e.x, ',', e.y, ',', e.z); }

RawShape resolve_shape(const std::string& path, const RawOptions& options) {
  const auto name = parse_raw_name(path);
  RawShape shape;
  if (name && options.extent && *options.extent != name->extent) {
    throw contradiction(path, "--dims", dims_text(*options.extent), extent_text(name->extent));
  }
  if (!name && !options.extent) {
    throw usage_error(path, "extent unknown; give --dims X,Y,Z and --type or name the file NAME_XxYxZ_TYPE.raw");
  }
  shape.extent = options.extent ? *options.extent : name->extent;

  const std::optional<ScalarType> named_type = name ? name->type : std::nullopt;
  if (named_type && options.type && *options.type != *named_type) {
    throw contradiction(path, "--type", scalar_name(*options.type), scalar_name(*named_type));
  }
  if (!named_type && !options.type) {
    const std::string found = name ? cat("unknown type '", name->type_text, "' in the file's name") : "type unknown";
    throw usage_error(path, cat(found, "; give --type with one of ", scalar_names()));
  }
  shape.type = options.type ? *options.type : *named_type;

  // A name without "be" says nothing: published little-endian and big-endian files both lack it.
  const bool named_big = name && name->type && name->big_endian;
  if (named_big && options.big_endian == false) throw contradiction(path, "--endian", "little", name->type_text);
  shape.big_endian = options.big_endian.value_or(named_big);
  return shape;
}

void check_geometry(const std::string& path, const SourceInfo& info) {
  for (const double s : info.spacing) {
    if (!(s > 0.0) || !std::isfinite(s))
      throw usage_error(path, cat("--spacing has ", s, "; each must be finite and above 0"));
  }
  for (const double o : info.origin) {
    if (!std::isfinite(o)) throw usage_error(path, cat("--origin has ", o, "; each must be finite"));
  }
}

void check_size(const InputFile& file, const RawShape& shape, std::uint64_t offset) {
  const std::uint64_t values = checked_volume_bytes(shape.extent, scalar_bytes(shape.type), file.path());
  const std::uint64_t expected = offset + std::min(values, ~offset);
  if (expected == file.size()) return;
  const bool too_short = expected > file.size();
  const std::uint64_t difference = too_short ? expected - file.size() : file.size() - expected;
  throw Error(ErrorKind::input, cat(file.path(), ": ", difference, difference == 1 ? " byte too " : " bytes too ",
                                    too_short ? "short" : "long", ": ", extent_text(shape.extent), ' ',
                                    scalar_name(shape.type), " after an offset of ", offset, " needs ", expected,
                                    " bytes, the file has ", file.size(), "; check --dims, --type and --offset"));
}

class RawSource final : public VolumeSource {
 public:
  RawSource(const std::string& path, const RawOptions& options)
      : file_(path, options.direct_io), shape_(resolve_shape(path, options)), offset_(options.offset) {
    check_size(file_, shape_, offset_);
    info_.path = path;
    info_.format = "raw";
    info_.extent = shape_.extent;
    info_.type = shape_.type;
    info_.spacing = options.spacing.value_or(info_.spacing);
    info_.origin = options.origin.value_or(info_.origin);
    info_.file_bytes = file_.size();
    info_.mtime_ns = file_.mtime_ns();
    check_geometry(path, info_);
  }

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {scalar_bytes(shape_.type), {}, {}}; }
  std::uint64_t bytes_read() const override { return file_.bytes_read(); }

  bool in_memory() const override { return file_.looks_cached(); }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    const std::int64_t bytes = box.voxels() * static_cast<std::int64_t>(scalar_bytes(shape_.type));
    const auto threads = std::clamp<std::int64_t>(bytes / kBytesPerThread, 1, static_cast<std::int64_t>(kIoThreads));
    return read_by(threads, box, values,
                   [this](const BoxPiece& piece) { return file_.path_for(piece.offset, piece.bytes); });
  }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override {
    return read_by(1, box, values, [](const BoxPiece&) { return ReadPath::cache; });
  }

 private:
  ConversionLoss read_by(std::int64_t threads, const Box& box, std::span<float> values, const auto& path_for) {
    if (box.empty() || !info_.domain().contains(box) || std::cmp_not_equal(values.size(), box.voxels())) {
      throw Error(ErrorKind::internal, cat(info_.path, ": read of box ", box_text(box), " into ", values.size(),
                                           " values does not fit ", box_text(info_.domain())));
    }
    const BoxPieces pieces(shape_.extent, box, scalar_bytes(shape_.type), offset_, kPieceBytes);
    ConversionLoss total;
    std::mutex mutex;
    for_pieces(pieces.size(), static_cast<std::size_t>(threads), [&](std::int64_t i) {
      const BoxPiece piece = pieces.piece(i);
      const ConversionLoss loss = read_piece(piece, path_for(piece), values);
      const std::lock_guard lock(mutex);
      total.add(loss);
    });
    return total;
  }

  ConversionLoss read_piece(const BoxPiece& piece, ReadPath path, std::span<float> values) {
    const auto run = static_cast<std::size_t>(piece.run_voxels);
    values = values.subspan(static_cast<std::size_t>(piece.first_value), run * static_cast<std::size_t>(piece.runs));
    if (path != ReadPath::direct && piece.runs == 1 && is_native_float32(shape_.type, shape_.big_endian)) {
      file_.read_buffered(piece.offset, std::as_writable_bytes(values), path);
      return {};
    }

    const StagingPool::Lease staging(staging_);
    std::span<const std::byte> bytes;
    if (path == ReadPath::direct) {
      bytes = file_.read_direct(piece.offset, piece.bytes, staging.bytes());
    } else {
      file_.read_buffered(piece.offset, staging.bytes().first(piece.bytes), path);
      bytes = staging.bytes().first(piece.bytes);
    }
    ConversionLoss loss;
    for (std::size_t r = 0; r < static_cast<std::size_t>(piece.runs); ++r) {
      const auto run_bytes = bytes.subspan(r * piece.stride_bytes, run * scalar_bytes(shape_.type));
      loss.add(convert_values(run_bytes, shape_.type, shape_.big_endian, values.subspan(r * run, run)));
    }
    return loss;
  }

  InputFile file_;
  RawShape shape_;
  std::uint64_t offset_;
  SourceInfo info_;
  StagingPool staging_;
};

}  // namespace

std::unique_ptr<VolumeSource> open_raw(const std::string& path, const RawOptions& options) {
  return std::make_unique<RawSource>(path, options);
}

}  // namespace weir
