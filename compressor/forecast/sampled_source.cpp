#include "compressor/forecast/sampled_source.h"

#include <algorithm>

#include "format/leaf/bounds.h"
#include "ingest/plan/for_pieces.h"
#include "ingest/plan/staging.h"

namespace weir {
namespace {

constexpr std::uint64_t kSmallCell = std::uint64_t{1} << 20U;  // bytes; several such cells are read at a time

std::uint64_t cell_bytes(const SamplePlan& plan) {
  return static_cast<std::uint64_t>(volume(plan.cell())) * sizeof(float);
}

// Returns where the region that holds voxel `at` ends, in whichever of two volumes it ends first, but at most `end`.
// Voxel 0 lies at index `first` in one volume and at `second` in the other.
std::int64_t part_end(std::int64_t at, std::int64_t end, std::int64_t first, std::int64_t second) {
  for (const std::int64_t origin : {first, second}) {
    end = std::min(end, (floor_div(origin + at, kLowerDim) + 1) * kLowerDim - origin);
  }
  return end;
}

// Returns the range of the values in `part`; ignores NaN.
MinMax range_in(std::span<const float> values, const Index3& extent, const Box& part) {
  MinMax range = kNoBounds;
  for (std::int64_t z = part.lo.z; z < part.hi.z; ++z) {
    for (std::int64_t y = part.lo.y; y < part.hi.y; ++y) {
      const auto at = static_cast<std::size_t>(linear_index({part.lo.x, y, z}, extent));
      for (const float v : values.subspan(at, static_cast<std::size_t>(part.hi.x - part.lo.x))) {
        range.min = v < range.min ? v : range.min;
        range.max = v > range.max ? v : range.max;
      }
    }
  }
  return range;
}

}  // namespace

SampledSource::SampledSource(VolumeSource& source, const SamplePlan& plan, From from, const Visibility* seen)
    : source_(source),
      plan_(plan),
      places_(from == From::volume ? SamplePlaces(plan, source.info().domain()) : SamplePlaces(plan, *source.places())),
      from_(from),
      seen_(seen),
      info_(source.info()),
      read_before_(source.bytes_read()),
      in_volume_(source.info().domain()),
      in_sample_(plan.domain()) {
  const Box domain = plan_.domain();
  info_.extent = domain.extent();
  info_.index_origin = domain.lo;
}

// Notes the ranges of `values`, which lie x fastest over piece.to, in parts that each lie in one region of the volume
// and in one region of the sample.
void SampledSource::note_ranges(const Piece& piece, std::span<const float> values) {
  if (plan_.whole() || from_ == From::copy) return;
  const Index3 extent = piece.to.extent();
  MinMax all = kNoBounds;
  for (Index3 lo, hi; lo.z < extent.z; lo.z = hi.z) {
    hi.z = part_end(lo.z, extent.z, piece.from.z, piece.to.lo.z);
    for (lo.y = 0; lo.y < extent.y; lo.y = hi.y) {
      hi.y = part_end(lo.y, extent.y, piece.from.y, piece.to.lo.y);
      for (lo.x = 0; lo.x < extent.x; lo.x = hi.x) {
        hi.x = part_end(lo.x, extent.x, piece.from.x, piece.to.lo.x);
        const MinMax range = range_in(values, extent, {lo, hi});
        const bool shown =
            seen_ == nullptr || (seen_->in_region({piece.from + lo, piece.from + hi}) && seen_->shows(range));
        const std::scoped_lock lock(mutex_);
        if (shown) {
          widen(all, range);
          in_volume_.add(piece.from + lo, range);
          in_sample_.add(piece.to.lo + lo, range);
        } else {
          in_volume_.add_hidden(piece.from + lo);
          in_sample_.add_hidden(piece.to.lo + lo);
        }
      }
    }
  }
  const std::scoped_lock lock(mutex_);
  if (all.min < all.max) varied_voxels_ += piece.to.voxels();
}

void SampledSource::find_reaches(const std::atomic<bool>* cancel) {
  if (source_.access().chunk != Index3{}) return;
  reaches_.emplace(source_, plan_, cancel);
  places_.set_reaches(&*reaches_);
}

double SampledSource::varied_share() const {
  const std::scoped_lock lock(mutex_);
  return static_cast<double>(varied_voxels_) / static_cast<double>(voxels_read_);
}

std::uint64_t SampledSource::working_bytes() const {
  if (plan_.whole()) return source_.working_bytes();  // values are read directly to their destination
  const std::uint64_t cell = cell_bytes(plan_);
  const std::uint64_t readers = cell > kSmallCell ? 1 : kIoThreads;
  return source_.working_bytes() + readers * cell;
}

std::vector<SampledSource::Piece> SampledSource::pieces_of(const Box& box) const {
  const Index3 counts = plan_.counts();
  const Index3 cell = plan_.cell();
  const Index3 lo = box.lo - info_.index_origin;
  const Index3 last = box.hi - info_.index_origin - Index3{1, 1, 1};
  const Box places{{lo.x / cell.x, lo.y / cell.y, lo.z / cell.z},
                   min({last.x / cell.x + 1, last.y / cell.y + 1, last.z / cell.z + 1}, counts)};
  std::vector<Piece> pieces;
  pieces.reserve(static_cast<std::size_t>(places.voxels()));
  for_each_index(places, [&](const Index3& place) {
    const Box whole = plan_.box(place);
    const Box to = intersect(whole, box);
    const Index3 corner = from_ == From::volume ? plan_.source_corner(place) : plan_.sample_corner(place);
    pieces.push_back({to, corner + (to.lo - whole.lo)});
  });
  return pieces;
}

ConversionLoss SampledSource::read_piece(const Piece& piece, const Box& box, std::span<float> values, bool alone) {
  const Index3 extent = piece.to.extent();
  const Index3 of_box = box.extent();
  const Box from{piece.from, piece.from + extent};
  const auto read_into = [&](std::span<float> target) {
    const ConversionLoss loss = alone ? source_.read_alone(from, target) : source_.read(from, target);
    note_ranges(piece, target);
    return loss;
  };
  const Index3 at = piece.to.lo - box.lo;
  const auto count = static_cast<std::size_t>(volume(extent));
  if (extent.x == of_box.x && extent.y == of_box.y) {
    return read_into(values.subspan(static_cast<std::size_t>(linear_index(at, of_box)), count));
  }
  std::vector<float> buffer(count);
  const ConversionLoss loss = read_into(buffer);
  const float* row = buffer.data();
  for (std::int64_t z = 0; z < extent.z; ++z) {
    for (std::int64_t y = 0; y < extent.y; ++y, row += extent.x) {
      std::copy_n(row, extent.x, values.data() + linear_index(at + Index3{0, y, z}, of_box));
    }
  }
  return loss;
}

ConversionLoss SampledSource::read(const Box& box, std::span<float> values) {
  voxels_read_ += box.voxels();
  const std::vector<Piece> pieces = pieces_of(box);
  ConversionLoss total;
  std::mutex mutex;
  // One large cell is enough to keep the source busy.
  const std::size_t readers = cell_bytes(plan_) > kSmallCell ? 1 : kIoThreads;
  for_pieces(static_cast<std::int64_t>(pieces.size()), readers, [&](std::int64_t i) {
    const ConversionLoss loss = read_piece(pieces[static_cast<std::size_t>(i)], box, values, false);
    const std::scoped_lock lock(mutex);
    total.add(loss);
  });
  return total;
}

ConversionLoss SampledSource::read_alone(const Box& box, std::span<float> values) {
  voxels_read_ += box.voxels();
  ConversionLoss total;
  for (const Piece& piece : pieces_of(box)) total.add(read_piece(piece, box, values, true));
  return total;
}

}  // namespace weir
