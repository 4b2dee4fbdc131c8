#include "ingest/source/index_choice.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

/// The most volumes of one call: about as many files as a directory handles well.
constexpr std::uint64_t kMostPositions = 1'000'000;

// Reads one end of a range. An empty text is valid and leaves `end` unset.
bool read_end(std::string_view text, std::optional<std::int64_t>& end) {
  if (text.empty()) return true;
  end = parse_int(text);
  return end.has_value();
}

std::string choice_text(const AxisChoice& choice) {
  const auto end = [](const std::optional<std::int64_t>& position) {
    return position ? cat(*position) : std::string();
  };
  return choice.range ? cat(end(choice.first), ':', end(choice.end)) : cat(*choice.first);
}

// Returns the position among `axes` of the axis that the choice at `place` is for. Returns a position past the end if
// there is none.
std::size_t axis_of(const AxisChoice& choice, std::size_t place, std::span<const LeadingAxis> axes) {
  if (choice.axis.empty()) return place;
  const auto found =
      std::find_if(axes.begin(), axes.end(), [&](const LeadingAxis& axis) { return axis.name == choice.axis; });
  return static_cast<std::size_t>(found - axes.begin());
}

// Returns the chosen positions [first, end) of the axis `axis`, which messages call `name`.
std::pair<std::int64_t, std::int64_t> checked_bounds(const std::string& where, const std::string& name,
                                                     const AxisChoice& choice, const LeadingAxis& axis) {
  const std::int64_t extent = axis.extent;
  const auto counted = [extent](std::int64_t position) { return position < 0 ? position + extent : position; };
  const std::int64_t first = counted(choice.first.value_or(0));
  const std::int64_t last = choice.range ? counted(choice.end.value_or(extent)) - 1 : first;
  if (first < 0 || last >= extent) {
    throw usage_error(compose(where, ": ", option("index"), " has ", choice_text(choice), ", and ", name,
                              " has the positions 0 to ", extent - 1, unwritten_text(axis), ", or from the end -",
                              extent, " to -1"));
  }
  if (first > last) {
    throw usage_error(compose(where, ": ", option("index"), " has ", choice_text(choice), " for ", name,
                              ", which holds no position; give FROM:TO with FROM below TO"));
  }
  return {first, last + 1};
}

}  // namespace

std::string axis_name(const std::string& label, std::size_t i) { return label.empty() ? cat("axis ", i) : label; }

std::string unwritten_text(const LeadingAxis& axis) {
  if (axis.unwritten == 0) return {};
  const std::int64_t last = axis.extent + axis.unwritten - 1;
  return axis.unwritten == 1 ? cat(" (", last, " was not written)")
                             : cat(" (", axis.extent, " to ", last, " were not written)");
}

std::optional<AxisChoice> parse_axis_choice(std::string_view text) {
  AxisChoice choice;
  if (const std::size_t equals = text.rfind('='); equals != std::string_view::npos) {
    choice.axis = text.substr(0, equals);
    text.remove_prefix(equals + 1);
    if (choice.axis.empty()) return std::nullopt;
  }
  const std::size_t colon = text.find(':');
  choice.range = text == "*" || colon != std::string_view::npos;
  if (text == "*") return choice;
  if (!read_end(text.substr(0, colon), choice.first)) return std::nullopt;
  if (choice.range && !read_end(text.substr(colon + 1), choice.end)) return std::nullopt;
  if (!choice.range && !choice.first) return std::nullopt;
  return choice;
}

bool choices_fit(std::span<const AxisChoice> choices, std::span<const LeadingAxis> axes) {
  const bool named = std::any_of(choices.begin(), choices.end(), [](const AxisChoice& c) { return !c.axis.empty(); });
  if (!named) return choices.size() == axes.size();
  return std::all_of(choices.begin(), choices.end(), [&](const AxisChoice& choice) {
    return !choice.axis.empty() && axis_of(choice, 0, axes) < axes.size();
  });
}

std::vector<std::vector<std::int64_t>> chosen_positions(const std::string& where, std::span<const LeadingAxis> axes,
                                                        std::span<const AxisChoice> choices) {
  std::vector<const AxisChoice*> of_axis(axes.size());
  for (std::size_t place = 0; place < choices.size(); ++place) {
    const AxisChoice*& slot = of_axis.at(axis_of(choices[place], place, axes));
    if (slot != nullptr) {
      throw usage_error(compose(where, ": ", option("index"), " names ", choices[place].axis, " twice"));
    }
    slot = &choices[place];
  }
  const AxisChoice only{{}, false, 0, {}};
  std::vector<std::vector<std::int64_t>> positions{{}};
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    const std::int64_t extent = axes[axis].extent;
    const std::string name = axis_name(axes[axis].name, axis);
    if (of_axis[axis] == nullptr && extent != 1) {
      throw usage_error(compose(where, ": ", option("index"), " says nothing of ", name,
                                ", which has the positions 0 to ", extent - 1, "; add ", name, "=0"));
    }
    const auto [first, end] = checked_bounds(where, name, of_axis[axis] == nullptr ? only : *of_axis[axis], axes[axis]);
    const auto along = static_cast<std::uint64_t>(end - first);
    if (along > kMostPositions / positions.size()) {
      throw usage_error(compose(where, ": ", option("index"), " stands for more than ", kMostPositions,
                                " volumes: ", along, " along ", name, "; give ranges of positions, FIRST:END"));
    }
    std::vector<std::vector<std::int64_t>> longer;
    for (const std::vector<std::int64_t>& before : positions) {
      for (std::int64_t position = first; position < end; ++position) {
        longer.push_back(before);
        longer.back().push_back(position);
      }
    }
    positions = std::move(longer);
  }
  return positions;
}

}  // namespace weir
