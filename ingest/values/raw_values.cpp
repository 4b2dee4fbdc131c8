#include "ingest/values/raw_values.h"

#include <algorithm>
#include <mutex>
#include <span>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/plan/box_pieces.h"
#include "ingest/plan/for_pieces.h"
#include "ingest/plan/staging.h"
#include "ingest/source/extent.h"
#include "ingest/values/convert_values.h"
#include "ingest/values/decode_component.h"

namespace weir {
namespace {

/// Boxes below this many bytes of the file per thread are not worth another thread.
constexpr std::int64_t kBytesPerThread = 256 * 1024;

class RawValues final : public VolumeSource {
 public:
  RawValues(std::unique_ptr<InputFile> file, const RawLayout& layout, SourceInfo info)
      : file_(std::move(file)), layout_(layout), info_(std::move(info)) {
    const std::uint64_t bytes = checked_volume_bytes(info_.extent, layout.voxel_bytes(), info_.path);
    if (layout.offset > file_->size() || bytes > file_->size() - layout.offset) {
      throw Error(ErrorKind::internal, cat(info_.path, ": ", bytes, " bytes of values at ", layout.offset,
                                           " do not fit a file of ", file_->size()));
    }
    info_.type = layout.type;
    info_.mapping = layout.mapping;
    if (info_.file_bytes == 0) info_.file_bytes = file_->size();
    if (info_.mtime_ns == 0) info_.mtime_ns = file_->mtime_ns();
    if (info_.files.empty()) info_.files = {file_->state()};
  }

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {layout_.voxel_bytes(), {}, {}}; }
  std::uint64_t bytes_read() const override { return file_->bytes_read(); }

  bool in_memory() const override { return file_->looks_cached(); }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    const std::int64_t bytes = box.voxels() * static_cast<std::int64_t>(layout_.voxel_bytes());
    const auto threads = std::clamp<std::int64_t>(bytes / kBytesPerThread, 1, static_cast<std::int64_t>(kIoThreads));
    return read_by(threads, box, values,
                   [this](const BoxPiece& piece) { return file_->path_for(piece.offset, piece.bytes); });
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
    const Box in_file{box.lo - info_.index_origin, box.hi - info_.index_origin};
    const BoxPieces pieces(info_.extent, in_file, layout_.voxel_bytes(), layout_.offset, kPieceBytes);
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
    if (path != ReadPath::direct && piece.runs == 1 && layout_.components.count == 1 &&
        is_native_float32(layout_.type, layout_.big_endian) && layout_.mapping.identity()) {
      file_->read_buffered(piece.offset, std::as_writable_bytes(values), path);
      return {};
    }

    const StagingPool::Lease staging(staging_);
    std::span<const std::byte> bytes;
    if (path == ReadPath::direct) {
      bytes = file_->read_direct(piece.offset, piece.bytes, staging.bytes());
    } else {
      file_->read_buffered(piece.offset, staging.bytes().first(piece.bytes), path);
      bytes = staging.bytes().first(piece.bytes);
    }
    ConversionLoss loss;
    for (std::size_t r = 0; r < static_cast<std::size_t>(piece.runs); ++r) {
      const auto run_bytes = bytes.subspan(r * piece.stride_bytes, run * layout_.voxel_bytes());
      loss.add(decode_component(run_bytes, layout_.type, layout_.big_endian, layout_.mapping, layout_.components,
                                values.subspan(r * run, run)));
    }
    return loss;
  }

  std::unique_ptr<InputFile> file_;
  RawLayout layout_;
  SourceInfo info_;
  StagingPool staging_;
};

}  // namespace

std::unique_ptr<VolumeSource> make_raw_values(std::unique_ptr<InputFile> file, const RawLayout& layout,
                                              SourceInfo info) {
  return std::make_unique<RawValues>(std::move(file), layout, std::move(info));
}

}  // namespace weir
