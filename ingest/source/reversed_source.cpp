#include "ingest/source/reversed_source.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ingest/source/forwarded_source.h"

namespace weir {
namespace {

class ReversedSource final : public ForwardedSource {
 public:
  ReversedSource(std::unique_ptr<VolumeSource> source, const std::array<bool, 3>& reversed)
      : ForwardedSource(std::move(source)), reversed_(reversed) {}

  // Mirroring swaps the beginning and the end of each chunk, so the chunk grid's corner is mirrored.
  AccessShape access() const override {
    AccessShape shape = source().access();
    shape.chunk_origin = mirrored({shape.chunk_origin, shape.chunk_origin}).lo;
    return shape;
  }
  ConversionLoss read(const Box& box, std::span<float> values) override {
    const ConversionLoss loss = source().read(mirrored(box), values);
    reverse(box.extent(), values);
    return loss;
  }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override {
    const ConversionLoss loss = source().read_alone(mirrored(box), values);
    reverse(box.extent(), values);
    return loss;
  }
  std::vector<Box> voxels_with_values(const Box& box) const override {
    std::vector<Box> boxes = source().voxels_with_values(mirrored(box));
    for (Box& part : boxes) part = mirrored(part);
    return boxes;
  }
  // If the extent is no multiple of 8, the source's leaves are not leaves of the mirrored volume.
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override { return {{box}}; }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    return read_alone(part.box, values);
  }
  ResidentVolume* resident() override { return nullptr; }
  const CellPlaces* places() const override { return nullptr; }
  const HeldLeaves* held(const Box& /*box*/) const override { return nullptr; }

 private:
  // Returns the box of the source that holds the voxels of `box`.
  Box mirrored(const Box& box) const { return mirrored_box(box, info().domain(), reversed_); }

  void reverse(const Index3& extent, std::span<float> values) const {
    const auto row = static_cast<std::size_t>(extent.x);
    const std::size_t plane = row * static_cast<std::size_t>(extent.y);
    if (reversed_[0]) {
      for (std::size_t at = 0; at < values.size(); at += row) std::ranges::reverse(values.subspan(at, row));
    }
    if (reversed_[1]) {
      for (std::size_t at = 0; at < values.size(); at += plane) reverse_runs(values.subspan(at, plane), row);
    }
    if (reversed_[2]) reverse_runs(values, plane);
  }

  // Reverses the order of the runs of `length` values. The values within a run keep their order.
  static void reverse_runs(std::span<float> values, std::size_t length) {
    for (std::size_t first = 0, last = values.size(); last - first >= 2 * length; first += length) {
      last -= length;
      std::swap_ranges(values.begin() + static_cast<std::ptrdiff_t>(first),
                       values.begin() + static_cast<std::ptrdiff_t>(first + length),
                       values.begin() + static_cast<std::ptrdiff_t>(last));
    }
  }

  std::array<bool, 3> reversed_;
};

}  // namespace

Box mirrored_box(const Box& box, const Box& domain, const std::array<bool, 3>& reversed) {
  const auto along = [](bool is_reversed, std::int64_t first, std::int64_t end, std::int64_t& lo, std::int64_t& hi) {
    if (!is_reversed) return;
    const std::int64_t from = first + end - hi;
    hi = first + end - lo;
    lo = from;
  };
  Box there = box;
  along(reversed[0], domain.lo.x, domain.hi.x, there.lo.x, there.hi.x);
  along(reversed[1], domain.lo.y, domain.hi.y, there.lo.y, there.hi.y);
  along(reversed[2], domain.lo.z, domain.hi.z, there.lo.z, there.hi.z);
  return there;
}

std::unique_ptr<VolumeSource> reverse_axes(std::unique_ptr<VolumeSource> source, const std::array<bool, 3>& reversed) {
  if (reversed == std::array<bool, 3>{}) return source;
  return std::make_unique<ReversedSource>(std::move(source), reversed);
}

}  // namespace weir
