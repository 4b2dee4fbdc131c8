#include "ingest/hdf5/storage/stored_boxes.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/plan/conversion_bytes.h"
#include "ingest/plan/page_buffer.h"
#include "ingest/source/extent.h"
#include "ingest/values/decode_component.h"

namespace weir {
namespace {

constexpr std::uint64_t kBufferShare = 16;  // of --memory, for the buffer

bool is_chunked(const StoredBoxes& boxes) { return boxes.chunk() != Index3{}; }

// Returns the bytes that the library keeps for the chunks of a read of `bytes` bytes; each chunk has `chunk_bytes`
// bytes.
std::uint64_t bytes_of_chunks(const StoredBoxes& boxes, std::uint64_t bytes, std::uint64_t chunk_bytes) {
  if (!is_chunked(boxes)) return 0;
  return std::clamp<std::uint64_t>(bytes / chunk_bytes, 1, kMostChunks) * kBytesOfChunk;
}

class StoredBoxSource final : public VolumeSource {
 public:
  StoredBoxSource(std::unique_ptr<StoredBoxes> boxes, SourceInfo info, bool big_endian,
                  const VoxelComponents& components, std::size_t buffer_bytes, std::uint64_t bytes_of_chunks)
      : boxes_(std::move(boxes)),
        info_(std::move(info)),
        big_endian_(big_endian),
        components_(components),
        buffer_(buffer_bytes),
        bytes_of_chunks_(bytes_of_chunks) {}

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {voxel_bytes(), boxes_->chunk(), boxes_->chunk_origin()}; }
  std::uint64_t working_bytes() const override {
    return boxes_->working_bytes() + buffer_.bytes().size() + bytes_of_chunks_;
  }
  std::uint64_t bytes_read() const override { return bytes_read_; }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    if (box.empty() || !info_.domain().contains(box) || std::cmp_not_equal(values.size(), box.voxels())) {
      throw Error(ErrorKind::internal, cat(info_.path, ": read of box ", box_text(box), " into ", values.size(),
                                           " values does not fit ", box_text(info_.domain())));
    }
    const std::lock_guard lock(mutex_);
    const Index3 unit = max(boxes_->chunk(), {1, 1, 1});
    const auto voxels = static_cast<std::int64_t>(buffer_.bytes().size() / voxel_bytes());
    const std::int64_t most = is_chunked(*boxes_) ? kMostChunks : voxels;
    const BoxCuts cuts(box, unit, boxes_->chunk_origin(), voxels, most);
    ConversionLoss loss;
    for (std::int64_t i = 0; i < cuts.size(); ++i) loss.add(read_part(cuts.part(i), box, values));
    return loss;
  }

 private:
  std::size_t voxel_bytes() const { return scalar_bytes(info_.type) * static_cast<std::size_t>(components_.count); }

  ConversionLoss read_part(const Box& part, const Box& box, std::span<float> values) {
    const auto stored = buffer_.bytes().first(static_cast<std::size_t>(part.voxels()) * voxel_bytes());
    boxes_->read(part, stored);
    bytes_read_ += stored.size();
    const Index3 e = part.extent();
    // Joins runs that are contiguous in the box as well.
    const bool rows = e.x == box.extent().x;
    const bool planes = rows && e.y == box.extent().y;
    const std::int64_t run = planes ? volume(e) : rows ? e.x * e.y : e.x;
    ConversionLoss loss;
    for (std::int64_t done = 0; done < volume(e); done += run) {
      const std::int64_t at = linear_index(part.lo + index_at(done, e) - box.lo, box.extent());
      loss.add(decode_component(
          stored.subspan(static_cast<std::size_t>(done) * voxel_bytes(), static_cast<std::size_t>(run) * voxel_bytes()),
          info_.type, big_endian_, info_.mapping, components_,
          values.subspan(static_cast<std::size_t>(at), static_cast<std::size_t>(run))));
    }
    return loss;
  }

  std::unique_ptr<StoredBoxes> boxes_;
  SourceInfo info_;
  bool big_endian_;
  VoxelComponents components_;
  std::mutex mutex_;  ///< of boxes_ and buffer_
  PageBuffer buffer_;
  std::uint64_t bytes_of_chunks_;  ///< that the library keeps
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace

void repeat_value(std::span<const std::byte> value, std::span<std::byte> stored) {
  std::size_t done = std::min(value.size(), stored.size());
  std::copy_n(value.begin(), done, stored.begin());
  for (std::size_t more = 0; done > 0 && done < stored.size(); done += more) {
    more = std::min(done, stored.size() - done);
    std::copy_n(stored.begin(), more, stored.begin() + static_cast<std::ptrdiff_t>(done));
  }
}

std::unique_ptr<VolumeSource> make_stored_box_source(std::unique_ptr<StoredBoxes> boxes, SourceInfo info,
                                                     bool big_endian, std::uint64_t memory, const std::string& where,
                                                     const VoxelComponents& components) {
  const std::uint64_t voxel_bytes = scalar_bytes(info.type) * static_cast<std::uint64_t>(components.count);
  // A chunk may reach beyond the volume; the requested voxels do not.
  const std::uint64_t chunk_bytes =
      static_cast<std::uint64_t>(volume(min(max(boxes->chunk(), {1, 1, 1}), info.extent))) * voxel_bytes;
  const std::uint64_t ample = std::min(kAmpleBuffer, memory / kBufferShare) / voxel_bytes * voxel_bytes;
  const std::uint64_t buffer_bytes = std::max(chunk_bytes, ample);
  const std::uint64_t of_chunks = bytes_of_chunks(*boxes, buffer_bytes, chunk_bytes);
  const std::uint64_t needed = buffer_bytes + boxes->working_bytes() + of_chunks;
  if (needed > memory / 2) {
    throw Error(ErrorKind::usage,
                compose(where, ": reading one of its chunks takes ", format_bytes(needed), ", more than half of ",
                        option("memory", format_bytes(memory)), "; give at least ", memory_beside_conversion(needed)));
  }
  return std::make_unique<StoredBoxSource>(std::move(boxes), std::move(info), big_endian, components,
                                           static_cast<std::size_t>(buffer_bytes), of_chunks);
}

BoxCuts::BoxCuts(const Box& box, const Index3& unit, const Index3& corner, std::int64_t voxels, std::int64_t most_units)
    : box_(box), part_(unit) {
  const auto floored = [](std::int64_t lo, std::int64_t step, std::int64_t from) {
    return from + floor_div(lo - from, step) * step;
  };
  first_ = {floored(box.lo.x, unit.x, corner.x), floored(box.lo.y, unit.y, corner.y),
            floored(box.lo.z, unit.z, corner.z)};
  const Index3 span = box.hi - first_;
  const auto grow = [&](std::int64_t& edge, std::int64_t all) {
    const std::int64_t one = volume(min(part_, box.extent()));
    const std::int64_t times = std::clamp<std::int64_t>(std::min(voxels / one, most_units), 1, ceil_div(all, edge));
    edge *= times;
    most_units /= times;
    return edge >= all;
  };
  if (grow(part_.x, span.x) && grow(part_.y, span.y)) grow(part_.z, span.z);
  count_ = {ceil_div(span.x, part_.x), ceil_div(span.y, part_.y), ceil_div(span.z, part_.z)};
}

Box BoxCuts::part(std::int64_t i) const {
  const Index3 at = index_at(i, count_);
  const Index3 lo = first_ + Index3{at.x * part_.x, at.y * part_.y, at.z * part_.z};
  return intersect({lo, lo + part_}, box_);
}

}  // namespace weir
