// Values of a leaf that are known to repeat each other, as those of coarse cells do on a finer grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace weir {

/// What sums over the 512 values of a leaf, eight in a row and 64 in a plane, need not compute again. The sums
/// themselves are the same, addition by addition.
struct LeafRepeats {
  bool twins = false;      ///< the second of each two rows is the first
  std::size_t planes = 1;  ///< as many planes, from each multiple of this on, are the same: 1, 2, 4 or 8
  std::size_t rows = 1;    ///< as many rows of a plane are the same
  std::size_t row = 1;     ///< as many values of a row are the same, where that is known

  /// Of groups of `rows` rows in each of `planes` planes, and of `row` values in each of these rows.
  static LeafRepeats of(std::int64_t rows, std::int64_t planes, std::int64_t row = 1) {
    if (rows <= 1) return {};
    return {true, static_cast<std::size_t>(planes), static_cast<std::size_t>(rows), static_cast<std::size_t>(row)};
  }

  /// Values of a group.
  std::size_t times() const { return planes * rows * row; }
};

/// Pairs of rows in a plane; the first row of pair k of a plane begins at its value kTwinStep * k.
inline constexpr std::size_t kTwins = 4;
inline constexpr std::size_t kTwinStep = 16;
inline constexpr std::size_t kTwinPlane = kTwins * kTwinStep;

/// The first of each group of the 512 values, and their number.
template <typename Value>
std::size_t take_distinct(const Value* values, const LeafRepeats& repeats, Value* distinct) {
  std::size_t count = 0;
  for (std::size_t x = 0; x < 8; x += repeats.planes) {
    for (std::size_t y = 0; y < 8; y += repeats.rows) {
      for (std::size_t z = 0; z < 8; z += repeats.row) distinct[count++] = values[x << 6U | y << 3U | z];
    }
  }
  return count;
}

/// Writes each of them to all values of its group.
template <typename Value>
[[gnu::always_inline]] inline void repeat_groups(const Value* distinct, const LeafRepeats& repeats, Value* values) {
  for (std::size_t x = 0; x < 8; x += repeats.planes) {
    for (std::size_t y = 0; y < 8; y += repeats.rows, distinct += 8 / repeats.row) {
      std::array<Value, 8> row;
      for (std::size_t z = 0; z < 8; ++z) row[z] = distinct[z / repeats.row];
      for (std::size_t plane = x; plane < x + repeats.planes; ++plane) {
        for (std::size_t i = y; i < y + repeats.rows; ++i)
          std::memcpy(values + 64 * plane + 8 * i, row.data(), sizeof row);
      }
    }
  }
}

template <typename Value>
void repeat_distinct(const Value* distinct, const LeafRepeats& repeats, Value* values) {
  const auto is_cube = [&](std::size_t side) {
    return repeats.planes == side && repeats.rows == side && repeats.row == side;
  };
  // Lengths that the compiler knows.
  if (is_cube(2)) return repeat_groups(distinct, {true, 2, 2, 2}, values);
  if (is_cube(4)) return repeat_groups(distinct, {true, 4, 4, 4}, values);
  repeat_groups(distinct, repeats, values);
}

}  // namespace weir
