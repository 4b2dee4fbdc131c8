#include "ingest/plan/block_parts.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "ingest/plan/repeat_groups.h"

namespace weir {
namespace {

Box leaves_of(const Box& box) {
  return {floor_div(box.lo, kLeafDim), floor_div(box.hi - Index3{1, 1, 1}, kLeafDim) + Index3{1, 1, 1}};
}

void repeat_row(const float* distinct, std::int64_t by, std::int64_t count, float* row) {
  for (std::int64_t x = 0; x < count; ++x) row[x] = distinct[x / by];
}

// Copies a number of values that the compiler knows: a leaf's rows are too short for a call of memcpy.
template <std::size_t Count>
void copy_values(const float* from, float* to) {
  std::memcpy(to, from, Count * sizeof(float));
}

void copy_row(const float* from, std::int64_t count, float* to) {
  if (count == 2) return copy_values<2>(from, to);
  if (count == 4) return copy_values<4>(from, to);
  if (count == 8) return copy_values<8>(from, to);
  std::copy_n(from, count, to);
}

void copy_plane(const float* from, std::int64_t count, float* to) {
  if (count == 64) return copy_values<64>(from, to);
  std::copy_n(from, count, to);
}

}  // namespace

BlockParts::BlockParts(std::vector<RepeatedPart> parts, const Box& voxels)
    : parts_(std::move(parts)), leaves_(leaves_of(voxels)), part_of_(static_cast<std::size_t>(leaves_.voxels())) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const auto shift = [](std::int64_t by) {
      return static_cast<std::int64_t>(std::countr_zero(static_cast<std::uint64_t>(by)));
    };
    const Index3& by = parts_[i].by;
    places_.push_back({first, parts_[i].groups(), {shift(by.x), shift(by.y), shift(by.z)}});
    first += static_cast<std::size_t>(parts_[i].values());
    for_each_index(leaves_of(parts_[i].box), [&](const Index3& leaf) {
      part_of_[static_cast<std::size_t>(linear_index(leaf - leaves_.lo, leaves_.extent()))] =
          static_cast<std::uint32_t>(i);
    });
  }
}

ConversionLoss BlockParts::read(VolumeSource& source, std::span<float> values) const {
  ConversionLoss loss;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const RepeatedPart& part = parts_[i];
    loss.add(source.read_repeated(part, values.subspan(places_[i].first, static_cast<std::size_t>(part.values()))));
  }
  return loss;
}

Index3 BlockParts::gather(std::span<const float> values, const Box& leaf, std::span<float> distinct) const {
  const Index3 at = floor_div(leaf.lo, kLeafDim) - leaves_.lo;
  const std::size_t i = part_of_[static_cast<std::size_t>(linear_index(at, leaves_.extent()))];
  const RepeatedPart& part = parts_[i];
  const auto& [first, of_part, shifts] = places_[i];
  const Index3& shift = shifts;  // clang 14 captures no structured binding
  const auto groups_of = [&shift](const Index3& e) { return Index3{e.x >> shift.x, e.y >> shift.y, e.z >> shift.z}; };
  const Index3 groups = groups_of(leaf.extent());
  const float* const corner = values.data() + first + linear_index(groups_of(leaf.lo - part.box.lo), of_part);
  float* out = distinct.data();
  for (std::int64_t z = 0; z < groups.z; ++z) {
    for (std::int64_t y = 0; y < groups.y; ++y, out += groups.x)
      copy_row(corner + of_part.x * (y + of_part.y * z), groups.x, out);
  }
  return part.by;
}

void repeat_values(const float* distinct, const Index3& by, const Index3& extent, float* values) {
  constexpr Index3 kLeaf{kLeafDim, kLeafDim, kLeafDim};
  if (extent == kLeaf) {
    const LeafGroups groups{static_cast<std::size_t>(by.z), static_cast<std::size_t>(by.y),
                            static_cast<std::size_t>(by.x)};
    return repeat_groups(groups, distinct, values);
  }
  const std::int64_t plane = extent.x * extent.y;
  for (std::int64_t z = 0; z < extent.z; z += by.z) {
    float* const first = values + plane * z;
    for (std::int64_t y = 0; y < extent.y; y += by.y) {
      float* const row = first + extent.x * y;
      repeat_row(distinct, by.x, extent.x, row);
      distinct += extent.x / by.x;
      for (std::int64_t i = 1; i < by.y; ++i) copy_row(row, extent.x, row + extent.x * i);
    }
    for (std::int64_t i = 1; i < by.z; ++i) copy_plane(first, plane, first + plane * i);
  }
}

}  // namespace weir
