#include "ingest/amrex/linear_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace weir {
namespace {

/// Interpolation along one axis: two coarse cells and the weight of the second.
struct Between {
  std::int64_t lower = 0;
  std::int64_t upper = 0;
  std::int64_t own = 0;  ///< the coarse cell that the fine cell lies in
  double weight = 0;
};

Between between(std::int64_t fine, std::int64_t by, std::int64_t lo, std::int64_t hi) {
  // In coarse centres, the centre of fine cell i is at (i + 1/2) / by - 1/2. Times 2 `by`, it is a whole number.
  const std::int64_t twice = 2 * fine + 1 - by;
  Between b;
  b.own = fine / by;
  const std::int64_t below = floor_div(twice, 2 * by);
  b.weight = static_cast<double>(twice - below * 2 * by) / static_cast<double>(2 * by);
  b.lower = std::clamp(below, lo, hi - 1);
  b.upper = std::clamp(below + 1, lo, hi - 1);
  return b;
}

}  // namespace

Box linear_support(const Box& fine, const Index3& by, const Index3& extent) {
  const Index3 side{by.x > 1 ? 1 : 0, by.y > 1 ? 1 : 0, by.z > 1 ? 1 : 0};
  const Box own{{fine.lo.x / by.x, fine.lo.y / by.y, fine.lo.z / by.z},
                {ceil_div(fine.hi.x, by.x), ceil_div(fine.hi.y, by.y), ceil_div(fine.hi.z, by.z)}};
  return intersect({own.lo - side, own.hi + side}, {{0, 0, 0}, extent});
}

void upsample_linear(const CellValues& coarse, const Index3& by, const Box& part, const Box& fine,
                     std::span<float> values) {
  const Index3 e = coarse.box.extent();
  const auto value = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return static_cast<double>(
        coarse.values[static_cast<std::size_t>(linear_index(Index3{x, y, z} - coarse.box.lo, e))]);
  };
  for (std::int64_t z = part.lo.z; z < part.hi.z; ++z) {
    const Between in_z = between(z, by.z, coarse.box.lo.z, coarse.box.hi.z);
    for (std::int64_t y = part.lo.y; y < part.hi.y; ++y) {
      const Between in_y = between(y, by.y, coarse.box.lo.y, coarse.box.hi.y);
      // The weights of the four rows of cells around the fine row.
      const std::array<double, 4> weights{(1 - in_y.weight) * (1 - in_z.weight), in_y.weight * (1 - in_z.weight),
                                          (1 - in_y.weight) * in_z.weight, in_y.weight * in_z.weight};
      const auto column = [&](std::int64_t x) {
        double sum = 0;
        for (std::size_t row = 0; row < 4; ++row) {
          if (weights.at(row) == 0) continue;
          sum += weights.at(row) * value(x, row % 2 == 0 ? in_y.lower : in_y.upper, row < 2 ? in_z.lower : in_z.upper);
        }
        return sum;
      };
      float* out = values.data() + linear_index(Index3{part.lo.x, y, z} - fine.lo, fine.extent());
      std::int64_t column_at = coarse.box.lo.x - 1;
      std::array<double, 2> columns{};
      for (std::int64_t x = part.lo.x; x < part.hi.x; ++x) {
        const Between in_x = between(x, by.x, coarse.box.lo.x, coarse.box.hi.x);
        if (column_at != in_x.lower) columns[0] = column(in_x.lower);
        if (column_at != in_x.lower) columns[1] = in_x.weight == 0 ? columns[0] : column(in_x.upper);
        // At the edges both cells are clamped to one. Only a pair of different cells is identified by its first cell.
        column_at = in_x.upper == in_x.lower + 1 && in_x.weight != 0 ? in_x.lower : coarse.box.lo.x - 1;
        const double sum = in_x.weight == 0 ? columns[0] : (1 - in_x.weight) * columns[0] + in_x.weight * columns[1];
        *out++ = std::isfinite(sum) ? static_cast<float>(sum) : static_cast<float>(value(in_x.own, in_y.own, in_z.own));
      }
    }
  }
}

}  // namespace weir
