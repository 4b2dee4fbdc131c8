// Expands one value per group of a leaf's voxels to all voxels of the group.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>

namespace weir {

/// Edge lengths of the groups of a leaf's 512 values: 1, 2, 4 or 8 each. `slow` is the slowest axis of the values,
/// whichever axis this is.
struct LeafGroups {
  std::size_t slow = 1;
  std::size_t middle = 1;
  std::size_t fast = 1;

  friend bool operator==(const LeafGroups&, const LeafGroups&) = default;
};

/// Writes `distinct`, one value per group in the order of the values, to `values`. Only repeat_groups() calls this
/// function: it is fast if the compiler knows the edges.
template <typename Value>
[[gnu::always_inline]] inline void repeat_groups_of(const LeafGroups& groups, const Value* distinct, Value* values) {
  for (std::size_t s = 0; s < 8; s += groups.slow) {
    for (std::size_t m = 0; m < 8; m += groups.middle, distinct += 8 / groups.fast) {
      std::array<Value, 8> row;
      for (std::size_t f = 0; f < 8; ++f) row[f] = distinct[f / groups.fast];
      for (std::size_t plane = s; plane < s + groups.slow; ++plane) {
        for (std::size_t i = m; i < m + groups.middle; ++i)
          std::memcpy(values + 64 * plane + 8 * i, row.data(), sizeof row);
      }
    }
  }
}
template <typename Value>
void repeat_groups(const LeafGroups& groups, const Value* distinct, Value* values) {
  if (groups == LeafGroups{2, 2, 2}) return repeat_groups_of({2, 2, 2}, distinct, values);
  if (groups == LeafGroups{4, 4, 4}) return repeat_groups_of({4, 4, 4}, distinct, values);
  repeat_groups_of(groups, distinct, values);
}

}  // namespace weir
