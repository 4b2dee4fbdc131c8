// --index: the positions on an array's leading axes that the user asks for.
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
  std::string name;  ///< empty if the file does not name it
  std::int64_t extent = 0;
  std::int64_t unwritten = 0;  ///< elements of the axis's dimension beyond `extent`, which the file has not stored
};

/// Returns `label`, the name of the axis at position `i` (from 0) of an array, or "axis 0" if `label` is empty.
std::string axis_name(const std::string& label, std::size_t i);

/// Returns " (2 was not written)" or " (2 to 4 were not written)" for an axis with unwritten elements, otherwise "".
std::string unwritten_text(const LeadingAxis& axis);

/// The choice on one leading axis: a position, or a half-open range of positions. Values below 0 count from the
/// axis's end.
struct AxisChoice {
  std::string axis;                   ///< name of the axis; if empty, the axis at this choice's own place in the list
  bool range = false;                 ///< else `first` alone
  std::optional<std::int64_t> first;  ///< start of the range; 0 if a range gives none
  std::optional<std::int64_t> end;    ///< end of the range; the axis's end if a range gives none

  /// Returns whether the choice is one position >= 0 on the axis at its own place, which means the same in every
  /// file.
  bool plain() const { return axis.empty() && !range && *first >= 0; }

  bool operator==(const AxisChoice&) const = default;
};

/// Parses "3", "-1", "0:2", "-3:" or "*", optionally with an axis's name before it ("time=3"). Returns nullopt for
/// any other text.
std::optional<AxisChoice> parse_axis_choice(std::string_view text);

/// Returns whether there is one choice for each of `axes`, or every choice names one of them.
bool choices_fit(std::span<const AxisChoice> choices, std::span<const LeadingAxis> axes);

/// Returns the positions on all of `axes` that `choices`, which fit them, stand for; the last axis changes first. An
/// axis that no choice names gets position 0 if it has only this one. Throws Error(usage), beginning with `where`, if
/// a position is outside its axis, a range is empty, an axis is named twice or a choice is missing.
std::vector<std::vector<std::int64_t>> chosen_positions(const std::string& where, std::span<const LeadingAxis> axes,
                                                        std::span<const AxisChoice> choices);

}  // namespace weir
