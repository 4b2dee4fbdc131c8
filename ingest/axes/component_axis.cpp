#include "ingest/axes/component_axis.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/space_axis.h"

namespace weir {
namespace {

bool names_components(const std::string& label) {
  constexpr std::array<std::string_view, 10> kNames{"comp", "ncomp", "vec",  "xyz",       "uvw",
                                                    "rgb",  "rgba",  "dirs", "direction", "channels"};
  const std::string name = lower_case(label);
  const auto has = [&](std::string_view word) { return name.find(word) != std::string::npos; };
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end() || has("component") || has("vector") ||
         has("tensor") || has("channel");
}

bool is_named(const AxisPlace& axis) {
  return axis.extent >= 2 && axis.extent <= kMostComponents && names_components(axis.label);
}

bool is_shorter(const AxisPlace& axis, std::span<const AxisPlace> others) {
  return std::all_of(others.begin(), others.end(),
                     [&](const AxisPlace& other) { return other.extent > axis.extent && !other.is_time; });
}

bool is_unknown(const AxisPlace& axis) { return axis.label.empty() && !axis.is_time; }

bool has_extent_of_components(const AxisPlace& axis) {
  constexpr std::array<std::int64_t, 4> kExtents{2, 3, 4, 9};
  return !axis.is_time && std::find(kExtents.begin(), kExtents.end(), axis.extent) != kExtents.end();
}

ComponentAxis by_extent(std::span<const AxisPlace> axes) {
  const AxisPlace& last = axes.back();
  const AxisPlace& before = axes[axes.size() - 2];
  if (!has_extent_of_components(last) || is_space_axis(last)) return {};
  if (names_x_axis(before.label) || (before.has_coordinates && !last.has_coordinates)) {
    return {last.extent, cat("by its extent, after the axis ", before.label), false};
  }
  const auto of_space = std::count_if(axes.begin(), axes.end() - 1, [](const AxisPlace& a) { return !a.is_time; });
  if (before.extent < last.extent || of_space < static_cast<std::ptrdiff_t>(kSpaceAxes)) return {};
  return {last.extent, "by its extent alone", false};
}

// Returns "0 to 2, x, y, z or magnitude".
std::string choices_text(std::int64_t count) {
  const std::string_view names = count == 2 ? ", x, y" : count == 3 ? ", x, y, z" : "";
  return cat("0 to ", count - 1, names, " or magnitude");
}

Error no_choice(std::span<const AxisPlace> axes, const ComponentAxis& vectors, const std::string& said) {
  const std::size_t positions = axes.size() - kSpaceAxes;
  return usage_error(compose(said, ", the last of them of components (", vectors.evidence, "); give ",
                             option("component"), ": ", choices_text(vectors.count), "; or ", option("index"), " with ",
                             positions, positions == 1 ? " position" : " positions", " for volumes of ",
                             axes.back().extent, " voxels along x"));
}

}  // namespace

ComponentAxis component_axis(std::span<const AxisPlace> axes) {
  if (axes.size() <= kSpaceAxes) return {};
  const AxisPlace& last = axes.back();
  if (is_named(last)) return {last.extent, cat("by its name ", last.label), false};
  return by_extent(axes);
}

bool components_before_time(std::span<const AxisPlace> axes) {
  const std::size_t all = axes.size();
  while (!axes.empty() && axes.back().is_time) axes = axes.first(axes.size() - 1);
  return !axes.empty() && axes.size() < all && is_named(axes.back());
}

namespace {

ComponentAxis asked_anywhere(std::span<const AxisPlace> axes) {
  const ComponentAxis sure = component_axis(axes);
  if (sure.found() || axes.size() <= kSpaceAxes) return sure;
  const AxisPlace& last = axes.back();
  const AxisPlace& leading = axes[axes.size() - 1 - kSpaceAxes];
  const auto may_be = [](const AxisPlace& axis) {
    return is_unknown(axis) && axis.extent >= 2 && axis.extent <= kMostComponents;
  };
  const ComponentAxis as_asked{last.extent, "as asked for", false};
  if (is_named(leading)) return {leading.extent, cat("by its name ", leading.label), true};
  const bool before_is_shorter = axes[axes.size() - 2].extent < last.extent;
  if (has_extent_of_components(last) && !is_space_axis(last) && !before_is_shorter) return as_asked;
  if (may_be(last) && is_shorter(last, axes.last(kSpaceAxes + 1).first(kSpaceAxes))) return as_asked;
  if (may_be(leading) && is_shorter(leading, axes.last(kSpaceAxes))) return {leading.extent, "as asked for", true};
  return has_extent_of_components(last) ? as_asked : ComponentAxis{};
}

}  // namespace

ComponentAxis asked_component_axis(std::span<const AxisPlace> axes, bool leading_counts) {
  const ComponentAxis vectors = asked_anywhere(axes);
  return vectors.leading && !leading_counts ? ComponentAxis{} : vectors;
}

ComponentAxis chosen_component_axis(std::span<const AxisPlace> axes, std::size_t positions, const std::string& said,
                                    const std::optional<ComponentChoice>& component, bool leading_counts) {
  const ComponentAxis vectors = component ? asked_component_axis(axes, leading_counts) : component_axis(axes);
  if (!component) {
    if (!vectors.found() || positions == axes.size() - kSpaceAxes) return {};
    throw no_choice(axes, vectors, said);
  }
  if (!vectors.found()) {
    throw usage_error(compose(said, ", none of them of components; leave ", option("component"), " out"));
  }
  if (!component->magnitude && component->position >= vectors.count) {
    throw usage_error(compose(said, ", and ", option("component"), " is ", component->position, "; give ",
                              choices_text(vectors.count)));
  }
  return vectors;
}

}  // namespace weir
