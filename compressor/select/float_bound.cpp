#include "compressor/select/float_bound.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

#include "compressor/select/leaf_choice.h"
#include "compressor/select/region_rows.h"

namespace weir {
namespace {

// More than the relative rounding of sums of a volume's errors, in any order.
constexpr double kSlack = 0x1p-20;

constexpr unsigned kShift = 51;  // of the bits of an error, to its class

std::uint64_t class_of(double error) { return std::bit_cast<std::uint64_t>(error) >> kShift; }

// Returns the least error of a class.
double least_of(std::size_t index) { return std::bit_cast<double>(std::uint64_t{index} << kShift); }

// Returns the least error of a leaf as a tile: its squared deviations from its exact mean. The row's `mean` is that
// mean, rounded.
double error_of_dropped(const LeafRow& row) {
  if (row.finite == 0) return 0;
  const auto residual = static_cast<double>(row.residual);
  return std::max(0.0, row.sse - residual * residual / static_cast<double>(row.finite));
}

}  // namespace

FloatBound::FloatBound(const TreeRegions& tree, const RowStore& rows)
    : classes_(class_of(std::numeric_limits<double>::max()) + 1) {
  tbb::enumerable_thread_specific<std::vector<Class>> local([&] { return std::vector<Class>(classes_.size()); });
  for_each_own_region(tree, rows, [&](std::int64_t, const RegionRows& region) {
    std::vector<Class>& classes = local.local();
    region.for_each([&](const Index3&, const LeafRow& row) {
      const double error = error_of_dropped(row);
      Class& one = classes[class_of(error)];
      one.error += error;
      ++one.leaves;
    });
  });
  for (const std::vector<Class>& some : local) {
    for (std::size_t i = 0; i < some.size(); ++i) {
      classes_[i].error += some[i].error;
      classes_[i].leaves += some[i].leaves;
    }
  }
}

// The leaves of the largest errors are kept, at best.
double FloatBound::least_error(std::uint64_t file_bytes) const {
  std::uint64_t kept = file_bytes / leaf_bytes(LeafWidth::float32);
  double error = 0;
  for (std::size_t i = classes_.size(); i-- > 0;) {
    const Class& one = classes_[i];
    const std::uint64_t of_these = std::min(kept, one.leaves);
    kept -= of_these;
    const double taken_away = of_these == 0 ? 0 : static_cast<double>(of_these) * least_of(i + 1);
    error += std::max(one.error - taken_away, static_cast<double>(one.leaves - of_these) * least_of(i));
  }
  return error * (1 - kSlack);
}

// The leaves of the smallest errors are dropped, at best.
std::uint64_t FloatBound::least_bytes(double squared_error) const {
  double left = squared_error * (1 + kSlack);
  std::uint64_t kept = 0;
  for (std::size_t i = 0; i < classes_.size(); ++i) {
    const Class& one = classes_[i];
    if (one.error <= left) {
      left -= one.error;
      continue;
    }
    const auto all = static_cast<double>(one.leaves);
    const double dropped = i == 0 ? all : std::min(all, left / least_of(i));
    kept += one.leaves - static_cast<std::uint64_t>(dropped);
    left = 0;
  }
  return kept * leaf_bytes(LeafWidth::float32);
}

}  // namespace weir
