#include "tools/report/surface_warning.h"

#include <array>
#include <cstdio>
#include <string>

#include "format/base/text.h"

namespace weir {
namespace {

std::string with_digits(double value, int digits) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

}  // namespace

std::string surface_warning(const Scene& scene, const MinMax& values) {
  if (scene.mode != RenderMode::iso) return {};
  const auto low = static_cast<double>(values.min);
  const auto high = static_cast<double>(values.max);
  if (!scene.volume.iso) {
    if (low < high) return {};
    return cat("every voxel has the value ", with_digits(low, 4), ": the picture shows no surface");
  }
  const double iso = *scene.volume.iso;
  if (iso >= low && iso <= high) {
    if (static_cast<float>(iso) > values.min) return {};
    return cat("the iso value ", with_digits(low, 4), " is the lowest of the values, up to ", with_digits(high, 4),
               ": the picture shows no surface");
  }
  const double passed = iso < low ? low : high;
  constexpr int kAll = 17;  // digits that tell any two doubles apart
  int digits = 4;
  while (digits < kAll && with_digits(iso, digits) == with_digits(passed, digits)) ++digits;
  return cat("the iso value ", with_digits(iso, digits), " lies outside the values, ", with_digits(low, digits), " .. ",
             with_digits(high, digits), ": the picture shows no surface");
}

}  // namespace weir
