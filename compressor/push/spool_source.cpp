#include "compressor/push/spool_source.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/scalar_type.h"
#include "format/base/text.h"
#include "ingest/plan/for_pieces.h"
#include "ingest/plan/staging.h"
#include "ingest/source/extent.h"
#include "ingest/values/decode_values.h"

namespace weir {
namespace {

/// Boxes below this many bytes per thread are not worth another thread.
constexpr std::int64_t kBytesPerThread = 256 * 1024;

class SpoolSource final : public VolumeSource {
 public:
  SpoolSource(const LeafSpool& spool, SourceInfo info) : spool_(spool), info_(std::move(info)) {}

  const SourceInfo& info() const override { return info_; }
  // A row of leaves lies in one piece, like the long rows of a file.
  AccessShape access() const override { return {scalar_bytes(info_.type), {}, {}}; }
  std::uint64_t bytes_read() const override { return bytes_read_; }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    const std::int64_t bytes = box.voxels() * static_cast<std::int64_t>(scalar_bytes(info_.type));
    const auto threads = std::clamp<std::int64_t>(bytes / kBytesPerThread, 1, static_cast<std::int64_t>(kIoThreads));
    return read_by(static_cast<std::size_t>(threads), box, values);
  }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override { return read_by(1, box, values); }

 private:
  ConversionLoss read_by(std::size_t threads, const Box& box, std::span<float> values) {
    if (box.empty() || !info_.domain().contains(box) || std::cmp_not_equal(values.size(), box.voxels())) {
      throw Error(ErrorKind::internal, cat(info_.path, ": read of box ", box_text(box), " into ", values.size(),
                                           " values does not fit ", box_text(info_.domain())));
    }
    const Box leaves = spool_.leaves().positions(box);
    const Index3 rows{1, leaves.extent().y, leaves.extent().z};
    std::mutex mutex;
    ConversionLoss total;
    for_pieces(volume(rows), threads, [&](std::int64_t i) {
      const ConversionLoss loss = read_row(leaves.lo + index_at(i, rows), leaves.extent().x, box, values);
      const std::lock_guard lock(mutex);
      total.add(loss);
    });
    return total;
  }

  // Reads the parts of `count` leaves, from `first` on along x, that lie in the box.
  ConversionLoss read_row(const Index3& first, std::int64_t count, const Box& box, std::span<float> values) {
    const StagingPool::Lease staging(staging_);
    const auto most = static_cast<std::int64_t>(kPieceBytes / spool_.leaf_bytes());
    ConversionLoss loss;
    for (std::int64_t x = 0; x < count; x += most) {
      loss.add(read_leaves(first + Index3{x, 0, 0}, std::min(most, count - x), box, values, staging.bytes()));
    }
    return loss;
  }

  // Does the same for as many leaves as `staging` holds.
  ConversionLoss read_leaves(const Index3& first, std::int64_t count, const Box& box, std::span<float> values,
                             std::span<std::byte> staging) {
    const std::int64_t linear = spool_.leaves().linear(first);
    std::vector<SpooledLeaf> states(static_cast<std::size_t>(count));
    spool_.read_states(linear, states);
    const auto spooled = [&](std::size_t i) {
      return i < states.size() && states[i].state == SpooledLeaf::State::spooled;
    };
    ConversionLoss loss;
    for (std::size_t i = 0; i < states.size();) {
      const Index3 leaf = first + Index3{static_cast<std::int64_t>(i), 0, 0};
      if (!spooled(i)) {
        loss.add(fill(leaf, states[i], box, values));
        ++i;
        continue;
      }
      std::size_t end = i + 1;
      while (spooled(end)) ++end;
      read_run(leaf, end - i, staging);
      for (std::size_t k = 0; i < end; ++i, ++k) {
        loss.add(place(first + Index3{static_cast<std::int64_t>(i), 0, 0}, staging.subspan(k * spool_.leaf_bytes()),
                       box, values));
      }
    }
    return loss;
  }

  // Reads consecutive spooled leaves, without the bytes behind the in-domain values of the last leaf.
  void read_run(const Index3& first, std::size_t count, std::span<std::byte> staging) {
    const Index3 last = first + Index3{static_cast<std::int64_t>(count) - 1, 0, 0};
    const std::size_t bytes = (count - 1) * spool_.leaf_bytes() + bytes_of(spool_.leaves().voxels(last).voxels());
    spool_.read_values(spool_.leaves().linear(first), staging.first(bytes));
    bytes_read_ += bytes;
  }

  // Places the part of a spooled leaf that lies in the box. `stored` begins with the leaf's values.
  ConversionLoss place(const Index3& leaf, std::span<const std::byte> stored, const Box& box, std::span<float> values) {
    const Box inside = spool_.leaves().voxels(leaf);
    const Box part = intersect(inside, box);
    std::array<float, kLeafVoxels> decoded;
    const Index3 e = part.extent();
    // Rows without a gap between them are placed as one row. Values outside the part must not count as a loss.
    const bool whole = part == inside;
    const std::int64_t run = whole ? part.voxels() : e.x;
    ConversionLoss loss;
    for (std::int64_t i = 0; i < part.voxels(); i += run) {
      const std::int64_t at = linear_index(part.lo - inside.lo + index_at(i, e), inside.extent());
      loss.add(decode_values(stored.subspan(bytes_of(at), bytes_of(run)), info_.type, kNativeIsBig, info_.mapping,
                             std::span(decoded).subspan(static_cast<std::size_t>(i), static_cast<std::size_t>(run))));
    }
    const float* from = decoded.data();
    for_each_row(part, box, values, [&](std::span<float> row) {
      std::copy_n(from, row.size(), row.data());
      from += row.size();
    });
    return loss;
  }

  // Does the same for a constant leaf.
  ConversionLoss fill(const Index3& leaf, const SpooledLeaf& state, const Box& box, std::span<float> values) const {
    if (state.state != SpooledLeaf::State::constant) {
      throw Error(ErrorKind::internal, cat(info_.path, ": leaf ", leaf.x, ",", leaf.y, ",", leaf.z,
                                           " is read from the spool before it was written"));
    }
    const Box part = intersect(spool_.leaves().voxels(leaf), box);
    float value = 0;
    const ConversionLoss loss = decode_values(std::span(state.value).first(scalar_bytes(info_.type)), info_.type,
                                              kNativeIsBig, info_.mapping, std::span(&value, 1));
    for_each_row(part, box, values, [&](std::span<float> row) { std::ranges::fill(row, value); });
    return loss.times(static_cast<std::uint64_t>(part.voxels()));
  }

  // Calls visit(row) for every row along x of `part` in the values of `box`.
  template <typename Visit>
  static void for_each_row(const Box& part, const Box& box, std::span<float> values, const Visit& visit) {
    const Index3 e = part.extent();
    for (std::int64_t z = 0; z < e.z; ++z) {
      for (std::int64_t y = 0; y < e.y; ++y) {
        const std::int64_t at = linear_index(part.lo - box.lo + Index3{0, y, z}, box.extent());
        visit(values.subspan(static_cast<std::size_t>(at), static_cast<std::size_t>(e.x)));
      }
    }
  }

  std::size_t bytes_of(std::int64_t count) const { return static_cast<std::size_t>(count) * scalar_bytes(info_.type); }

  const LeafSpool& spool_;
  SourceInfo info_;
  StagingPool staging_;
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace

SourceInfo as_pushed(SourceInfo info) {
  info.format = "pushed";
  info.file_bytes = checked_volume_bytes(info.extent, scalar_bytes(info.type), info.path);
  return info;
}

std::unique_ptr<VolumeSource> open_spool(const LeafSpool& spool, SourceInfo info) {
  return std::make_unique<SpoolSource>(spool, std::move(info));
}

}  // namespace weir
