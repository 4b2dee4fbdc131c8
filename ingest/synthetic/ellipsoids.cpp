#include "ingest/synthetic/ellipsoids.h"

#include <algorithm>

#include "format/base/simd.h"
#include "ingest/synthetic/hash.h"

namespace weir {
namespace {

constexpr float kFar = 1e30F;
constexpr float kSlack = 1e-3F;  // bounds are loosened by more than their rounding error

struct Range {
  float min = 0;
  float max = 0;
};

// Returns the range of (distance)^2 over positions lo ... hi - 1. Its minimum is zero if the centre is between them.
Range term_range(const Ellipsoid& e, std::size_t axis, std::int64_t lo, std::int64_t hi) {
  const float a = e.distance(axis, lo);
  const float b = e.distance(axis, hi - 1);
  return {(a > 0) == (b > 0) ? std::min(a * a, b * b) : 0.0F, std::max(a * a, b * b)};
}

WEIR_SIMD void take_lesser(const std::array<float, kTileDim>& terms, float rest, std::array<float, kTileDim>& q) {
  for (std::size_t x = 0; x < terms.size(); ++x) {
    const float other = terms[x] + rest;
    q[x] = other < q[x] ? other : q[x];
  }
}

}  // namespace

EllipsoidHeap make_heap(const SyntheticOptions& options) {
  const std::array<std::int64_t, 3> extent{options.extent.x, options.extent.y, options.extent.z};
  const std::uint64_t key = derive_key(options.seed, 1);
  EllipsoidHeap heap;
  for (std::size_t i = 0; i < heap.size(); ++i) {
    const auto random = [&](std::int64_t what) {
      return unit_float(hash_position(key, what, static_cast<std::int64_t>(i), 0));
    };
    // Centre and radii are in units of the extent.
    std::array<float, 3> centre{0.5F, 0.42F, 0.5F};
    std::array<float, 3> radii{0.38F, 0.24F, 0.36F};
    if (i > 0) {
      const float radius = 0.10F + 0.11F * random(3);
      centre = {0.26F + 0.48F * random(0), 0.32F + 0.36F * random(1), 0.26F + 0.48F * random(2)};
      radii = {radius, 0.9F * radius, radius};
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      heap[i].slope[axis] = 1.0F / (radii[axis] * static_cast<float>(extent[axis]));
      heap[i].shift[axis] = -centre[axis] / radii[axis];
    }
  }
  return heap;
}

TileEllipsoids::TileEllipsoids(const EllipsoidHeap& heap, const Box& box) : least_(kFar) {
  std::array<Range, kEllipsoids> ranges;
  float least_max = kFar;
  for (std::size_t i = 0; i < heap.size(); ++i) {
    const Range x = term_range(heap[i], 0, box.lo.x, box.hi.x);
    const Range y = term_range(heap[i], 1, box.lo.y, box.hi.y);
    const Range z = term_range(heap[i], 2, box.lo.z, box.hi.z);
    ranges[i] = {(x.min + y.min + z.min) * (1.0F - kSlack), (x.max + y.max + z.max) * (1.0F + kSlack)};
    least_ = std::min(least_, ranges[i].min);
    least_max = std::min(least_max, ranges[i].max);
  }
  for (std::size_t i = 0; i < heap.size(); ++i) {
    if (ranges[i].min > least_max) continue;
    Near& near = near_[count_++];
    near.ellipsoid = heap[i];
    near.least_x_term = term_range(heap[i], 0, box.lo.x, box.hi.x).min;
    for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) {
      near.x_terms[static_cast<std::size_t>(x - box.lo.x)] = heap[i].term(0, x);
    }
  }
}

float TileEllipsoids::least_in_row(std::int64_t y, std::int64_t z) const {
  float least = kFar;
  for (std::size_t i = 0; i < count_; ++i) {
    const Near& near = near_[i];
    least = std::min(least, near.least_x_term + (near.ellipsoid.term(1, y) + near.ellipsoid.term(2, z)));
  }
  return least * (1.0F - kSlack);
}

void TileEllipsoids::row(std::int64_t y, std::int64_t z, std::array<float, kTileDim>& q) const {
  q.fill(kFar);
  for (std::size_t i = 0; i < count_; ++i) {
    const Near& near = near_[i];
    take_lesser(near.x_terms, near.ellipsoid.term(1, y) + near.ellipsoid.term(2, z), q);
  }
}

}  // namespace weir
