#include "compressor/forecast/sample_plan.h"

#include <algorithm>

#include "format/base/mix_bits.h"

namespace weir {
namespace {

// In leaves. A file is read in runs of eight rows. Shorter rows would each cost a seek on a disk with a cold cache.
constexpr std::int64_t kLongestRow = 512;

// Returns a pseudo-random number from 0 to below 1 that is the same in every run.
double fraction_at(std::uint64_t place) {
  return static_cast<double>(mix_bits((place + 1) * kGoldenGamma) >> 11U) * 0x1p-53;
}

Index3 of_array(const std::array<std::int64_t, 3>& a) { return {a[0], a[1], a[2]}; }
std::array<std::int64_t, 3> to_array(const Index3& i) { return {i.x, i.y, i.z}; }

std::array<SampleAxis, 3> make_axes(const Box& domain, const AccessShape& access, std::int64_t brick) {
  const Index3& chunk = access.chunk;
  const Index3& edge = access.chunk_origin;
  return {SampleAxis(domain.lo.x, domain.hi.x, chunk.x, edge.x, kLongestRow, brick),
          SampleAxis(domain.lo.y, domain.hi.y, chunk.y, edge.y, 1, brick),
          SampleAxis(domain.lo.z, domain.hi.z, chunk.z, edge.z, 1, brick)};
}

}  // namespace

SamplePlan::SamplePlan(const Box& domain, const AccessShape& access, std::int64_t most_voxels, std::int64_t brick)
    : axes_(make_axes(domain, access, brick)) {
  if (domain.voxels() <= 2 * most_voxels) return;
  limit(most_voxels);
  if (whole() || places() >= kLeastPlaces) return;
  axes_ = make_axes(domain, access, brick);
  limit(std::max(most_voxels, domain.voxels() / 20));
}

// Takes fewer cells until the sample has at most `most_voxels`, each time along the axis with the smallest distance
// between places.
void SamplePlan::limit(std::int64_t most_voxels) {
  while (axes_[0].voxels() * axes_[1].voxels() * axes_[2].voxels() > most_voxels) {
    SampleAxis* densest = nullptr;
    for (const bool narrow : {false, true}) {
      for (SampleAxis& axis : axes_) {
        if (axis.taken() == 1 || axis.narrow() != narrow) continue;
        if (densest == nullptr || axis.span() < densest->span()) densest = &axis;
      }
      if (densest != nullptr) break;
    }
    if (densest == nullptr) return;
    densest->take_fewer();
  }
}

bool SamplePlan::whole() const {
  return std::ranges::all_of(axes_, [](const SampleAxis& axis) { return axis.whole(); });
}

std::int64_t SamplePlan::count(std::size_t axis) const {
  return axes_[axis].whole() ? 1 : axes_[axis].taken() / stride_[axis];
}

Index3 SamplePlan::counts() const { return {count(0), count(1), count(2)}; }

Index3 SamplePlan::cell() const {
  std::array<std::int64_t, 3> voxels{};
  for (std::size_t a = 0; a < 3; ++a) voxels[a] = axes_[a].whole() ? axes_[a].voxels() : axes_[a].cell();
  return of_array(voxels);
}

AccessShape SamplePlan::access(AccessShape shape) const {
  if (shape.chunk == Index3{}) return shape;
  const auto take = [](const SampleAxis& axis, std::int64_t& chunk, std::int64_t& origin) {
    if (axis.whole()) return;
    chunk = axis.cell();
    origin = 0;
  };
  take(axes_[0], shape.chunk.x, shape.chunk_origin.x);
  take(axes_[1], shape.chunk.y, shape.chunk_origin.y);
  take(axes_[2], shape.chunk.z, shape.chunk_origin.z);
  return shape;
}

Box SamplePlan::domain() const { return {box({0, 0, 0}).lo, box(counts() - Index3{1, 1, 1}).hi}; }

Box SamplePlan::box(const Index3& place) const {
  const auto at = to_array(place);
  const auto voxels = to_array(cell());
  std::array<std::int64_t, 3> lo{};
  for (std::size_t a = 0; a < 3; ++a) lo[a] = axes_[a].whole() ? axes_[a].lo() : at[a] * voxels[a];
  return {of_array(lo), of_array(lo) + of_array(voxels)};
}

std::array<std::int64_t, 3> SamplePlan::strata_of(const Index3& place) const {
  const auto at = to_array(place);
  std::array<std::int64_t, 3> strata{};
  for (std::size_t a = 0; a < 3; ++a) strata[a] = offset_[a] + stride_[a] * at[a];
  return strata;
}

Index3 SamplePlan::sample_corner(const Index3& place) const {
  const auto strata = strata_of(place);
  std::array<std::int64_t, 3> corner{};
  for (std::size_t a = 0; a < 3; ++a) corner[a] = axes_[a].whole() ? axes_[a].lo() : strata[a] * axes_[a].cell();
  return of_array(corner);
}

Index3 SamplePlan::source_corner(const Index3& place) const {
  const auto strata = strata_of(place);
  const Index3 all{axes_[0].taken(), axes_[1].taken(), axes_[2].taken()};
  const auto linear = static_cast<std::uint64_t>(linear_index(of_array(strata), all));
  std::array<std::int64_t, 3> corner{};
  for (std::size_t a = 0; a < 3; ++a) {
    corner[a] = axes_[a].whole() ? axes_[a].lo() : axes_[a].begin(strata[a], fraction_at(3 * linear + a));
  }
  return of_array(corner);
}

std::vector<SamplePlan> SamplePlan::parts() const {
  const int halvings = places() >= 64 ? 3 : places() >= 16 ? 2 : 0;
  std::vector<SamplePlan> parts{*this};
  for (int i = 0; i < halvings; ++i) {
    const auto of_axis = [&](std::size_t a, std::size_t b) { return parts[0].count(a) < parts[0].count(b); };
    const std::array<std::size_t, 3> all{0, 1, 2};
    const std::size_t axis = *std::ranges::max_element(all, of_axis);
    std::vector<SamplePlan> halves;
    for (const SamplePlan& part : parts) {
      for (const std::int64_t second : {0, 1}) {
        SamplePlan half = part;
        half.offset_[axis] += second * half.stride_[axis];
        half.stride_[axis] *= 2;
        halves.push_back(half);
      }
    }
    parts = std::move(halves);
  }
  return halvings == 0 ? std::vector<SamplePlan>{} : parts;
}

}  // namespace weir
