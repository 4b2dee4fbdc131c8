// Index space: voxels, 8^3 leaves, 128^3 lower nodes and 4096^3 upper nodes,
// and the arithmetic between them. All coordinates are signed 64-bit voxel (or
// node) indices; boxes are half open. A volume need not start at the origin:
// leaves lie on global multiples of 8, so the first one may overhang below.
#pragma once

#include <algorithm>
#include <cstdint>

namespace weir {

inline constexpr std::int64_t kLeafDim = 8;
inline constexpr std::int64_t kLeafVoxels = 512;
inline constexpr std::int64_t kLowerDim = 128;    ///< voxels along a lower internal node
inline constexpr std::int64_t kUpperDim = 4096;   ///< voxels along an upper internal node
inline constexpr std::int64_t kLowerLeaves = 16;  ///< leaves along a lower node
inline constexpr std::int64_t kUpperLowers = 32;  ///< lower nodes along an upper node

struct Index3 {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t z = 0;

  friend constexpr bool operator==(const Index3&, const Index3&) = default;
};

constexpr Index3 operator+(const Index3& a, const Index3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Index3 operator-(const Index3& a, const Index3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Index3 operator*(const Index3& a, std::int64_t s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr Index3 min(const Index3& a, const Index3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
constexpr Index3 max(const Index3& a, const Index3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
/// Returns the number of elements of the extent `e`; the caller has checked that it fits.
constexpr std::int64_t volume(const Index3& e) { return e.x * e.y * e.z; }
/// Returns the position of `i` in an array of `extent`, x fastest.
constexpr std::int64_t linear_index(const Index3& i, const Index3& extent) {
  return i.x + extent.x * (i.y + extent.y * i.z);
}
/// The inverse of linear_index().
constexpr Index3 index_at(std::int64_t linear, const Index3& extent) {
  return {linear % extent.x, linear / extent.x % extent.y, linear / (extent.x * extent.y)};
}

constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }
constexpr std::int64_t ceil_div(std::int64_t a, std::int64_t b) { return -floor_div(-a, b); }
constexpr Index3 floor_div(const Index3& a, std::int64_t b) {
  return {floor_div(a.x, b), floor_div(a.y, b), floor_div(a.z, b)};
}

/// Half-open box [lo, hi).
struct Box {
  Index3 lo;
  Index3 hi;

  constexpr Index3 extent() const { return hi - lo; }
  constexpr bool empty() const { return lo.x >= hi.x || lo.y >= hi.y || lo.z >= hi.z; }
  constexpr std::int64_t voxels() const { return empty() ? 0 : volume(extent()); }
  constexpr bool contains(const Index3& i) const {
    return i.x >= lo.x && i.x < hi.x && i.y >= lo.y && i.y < hi.y && i.z >= lo.z && i.z < hi.z;
  }
  constexpr bool contains(const Box& b) const { return contains(b.lo) && contains(b.hi - Index3{1, 1, 1}); }
  friend constexpr bool operator==(const Box&, const Box&) = default;
};

/// Returns the bytes of the voxels of `box` as float32.
constexpr std::uint64_t float32_bytes(const Box& box) {
  return static_cast<std::uint64_t>(box.voxels()) * sizeof(float);
}

constexpr Box intersect(const Box& a, const Box& b) { return {max(a.lo, b.lo), min(a.hi, b.hi)}; }

constexpr Box grown(const Box& box, std::int64_t by) {
  return {box.lo - Index3{by, by, by}, box.hi + Index3{by, by, by}};
}

/// Calls visit(index) for every index of `box`, x fastest.
template <typename Visit>
void for_each_index(const Box& box, const Visit& visit) {
  for (std::int64_t z = box.lo.z; z < box.hi.z; ++z) {
    for (std::int64_t y = box.lo.y; y < box.hi.y; ++y) {
      for (std::int64_t x = box.lo.x; x < box.hi.x; ++x) visit(Index3{x, y, z});
    }
  }
}

/// The nodes of edge length `dim` voxels that touch a domain, as a dense lattice.
/// `first` is the node coordinate (voxel index / dim, rounded down) of the lowest one.
struct NodeLattice {
  Box domain;    ///< voxels
  Index3 first;  ///< node coordinates
  Index3 count;  ///< nodes along each axis, all >= 1
  std::int64_t dim = kLeafDim;

  constexpr std::int64_t size() const { return volume(count); }
  /// Returns the voxels of the node at lattice position `i` (0 <= i < count), including those outside the domain.
  constexpr Box node_box(const Index3& i) const {
    const Index3 lo = (first + i) * dim;
    return {lo, lo + Index3{dim, dim, dim}};
  }
  /// Returns the part of node_box(i) inside the domain; never empty.
  constexpr Box voxels(const Index3& i) const { return intersect(node_box(i), domain); }
  /// Returns the voxels of all nodes at `positions`, a box that is not empty, including those outside the domain.
  constexpr Box nodes_box(const Box& positions) const {
    return {(first + positions.lo) * dim, (first + positions.hi) * dim};
  }
  constexpr Box voxels(const Box& positions) const { return intersect(nodes_box(positions), domain); }
  /// Returns the positions of the nodes that a non-empty box of voxels touches.
  constexpr Box positions(const Box& voxels) const {
    return {floor_div(voxels.lo, dim) - first, floor_div(voxels.hi - Index3{1, 1, 1}, dim) - first + Index3{1, 1, 1}};
  }
  /// Returns whether the node reaches outside the domain.
  constexpr bool overhangs(const Index3& i) const { return !domain.contains(node_box(i)); }
  constexpr std::int64_t linear(const Index3& i) const { return linear_index(i, count); }
  constexpr Index3 position(std::int64_t linear) const { return index_at(linear, count); }
};

/// Returns the lattice of nodes of `dim` voxels over a non-empty domain.
constexpr NodeLattice make_lattice(const Box& domain, std::int64_t dim) {
  const Index3 first = floor_div(domain.lo, dim);
  const Index3 last = floor_div(domain.hi - Index3{1, 1, 1}, dim);
  return {domain, first, last - first + Index3{1, 1, 1}, dim};
}

}  // namespace weir
