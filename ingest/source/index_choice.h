// Which positions of an array's leading axes are asked for: --index.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// An axis before the last three, on which a position is chosen.
struct LeadingAxis {
  std::string name;  ///< empty where the file has none for it
  std::int64_t extent = 0;
  std::int64_t unwritten = 0;  ///< elements that its dimension has behind these, and the file has not
};

/// Of the axis at position `i`, from 0, of an array: `label` or, where that is empty, "axis 0".
std::string axis_name(const std::string& label, std::size_t i);

/// Of an axis with unwritten elements, " (2 was not written)", " (2 to 4 were not written)"; else empty.
std::string unwritten_text(const LeadingAxis& axis);

/// What is asked of one leading axis: a position, or a range of them, half open. Below 0 counts from the axis's end.
struct AxisChoice {
  std::string axis;                   ///< its name; empty: the axis at this choice's own place
  bool range = false;                 ///< else `first` alone
  std::optional<std::int64_t> first;  ///< of a range that gives none: 0
  std::optional<std::int64_t> end;    ///< of a range that gives none: the axis's end

  /// Whether it is a position from 0 on, of the axis at its own place: one that says the same of any file.
  bool plain() const { return axis.empty() && !range && *first >= 0; }

  bool operator==(const AxisChoice&) const = default;
};

/// "3", "-1", "0:2", "-3:", "*", and with an axis's name before it, "time=3"; nullopt for any other text.
std::optional<AxisChoice> parse_axis_choice(std::string_view text);

/// Whether the choices are one for each of `axes`, or each has the name of one of them.
bool choices_fit(std::span<const AxisChoice> choices, std::span<const LeadingAxis> axes);

/// The positions on all of `axes` that `choices`, which fit them, stand for; the last axis changes first. An axis that
/// no choice names has position 0 where it has no other. Throws Error(usage), beginning with `where`, where a position
/// is outside its axis, a range holds none, an axis is named twice or a choice is left out.
std::vector<std::vector<std::int64_t>> chosen_positions(const std::string& where, std::span<const LeadingAxis> axes,
                                                        std::span<const AxisChoice> choices);

}  // namespace weir
