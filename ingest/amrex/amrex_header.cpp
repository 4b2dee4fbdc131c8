#include "ingest/amrex/amrex_header.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "format/base/ascii.h"
#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/source/extent.h"

namespace weir {
namespace {

constexpr std::int64_t kMostLevels = 32;
constexpr std::int64_t kMostRatio = 1024;

std::array<double, 3> three(PlotfileText& text, std::string_view what) {
  std::array<double, 3> values{};
  for (double& value : values) {
    value = text.real(what);
    if (!std::isfinite(value)) throw text.error(cat(what, " has ", value, ", and must be finite"));
  }
  return values;
}

std::vector<std::string> component_names(PlotfileText& text) {
  const std::int64_t count = text.integer_in("the number of components", 1, kMostAmrexComponents);
  text.rest_of_line();
  std::vector<std::string> names;
  for (std::int64_t i = 0; i < count; ++i) {
    if (text.next_byte() < 0) throw text.error(cat("ends after ", i, " of ", count, " names of components; it is cut"));
    names.push_back(text.rest_of_line());
  }
  return names;
}

/// Returns the ratio that the file states: of the first axis alone, with 0 for the others, or of all axes, "(2,2,1)".
Index3 stated_ratio(PlotfileText& text) {
  if (text.next_byte() == '(') return text.vector("a refinement ratio");
  return {text.integer_in("a refinement ratio", 1, kMostRatio), 0, 0};
}

std::string ratio_text(const Index3& ratio) {
  return ratio.y == 0 ? cat(ratio.x) : cat('(', ratio.x, ',', ratio.y, ',', ratio.z, ')');
}

/// Returns the ratio of the domain `fine` to the domain `coarse`.
Index3 domain_ratio(const PlotfileText& text, const Box& coarse, const Box& fine, std::size_t level) {
  const Index3 c = coarse.extent();
  const Index3 f = fine.extent();
  const Index3 ratio{f.x / c.x, f.y / c.y, f.z / c.z};
  const Index3 lo{coarse.lo.x * ratio.x, coarse.lo.y * ratio.y, coarse.lo.z * ratio.z};
  const bool whole = c.x * ratio.x == f.x && c.y * ratio.y == f.y && c.z * ratio.z == f.z && lo == fine.lo;
  if (!whole || std::max({ratio.x, ratio.y, ratio.z}) > kMostRatio) {
    throw text.error(cat("the domain of level ", level, ", ", box_text(fine), ", does not refine that of level ",
                         level - 1, ", ", box_text(coarse), ", by whole numbers; the header is damaged"));
  }
  return ratio;
}

void read_domains(PlotfileText& text, AmrexHeader& header) {
  const std::size_t levels = header.levels.size();
  std::vector<Index3> stated;
  for (std::size_t i = 1; i < levels; ++i) stated.push_back(stated_ratio(text));
  // Some codes also write the ratios of levels that could exist but do not.
  while (text.next_byte() >= '0' && text.next_byte() <= '9') text.skip_word("a refinement ratio");
  for (AmrexLevelHeader& level : header.levels) level.domain = text.box("a level's domain");
  for (std::size_t i = 1; i < levels; ++i) {
    AmrexLevelHeader& level = header.levels[i];
    level.ratio = domain_ratio(text, header.levels[i - 1].domain, level.domain, i);
    const Index3& s = stated[i - 1];
    if (s.y == 0 ? s.x != level.ratio.x : s != level.ratio) {
      throw text.error(cat("the ratio of level ", i, " to level ", i - 1, " is said to be ", ratio_text(s), ", and ",
                           ratio_text(level.ratio), " by their domains; the header is damaged"));
    }
  }
  while (text.next_byte() == '(') text.box("a level's domain");
}

/// Relative tolerance for numbers that must fit each other. Some codes write them with six digits.
constexpr double kDigitsSlack = 2e-5;

char axis_name(std::size_t axis) { return "xyz"[axis]; }

std::int64_t cells_along(const Box& domain, std::size_t axis) {
  const Index3 e = domain.extent();
  return axis == 0 ? e.x : axis == 1 ? e.y : e.z;
}

std::array<double, 3> upper_corner(PlotfileText& text, const std::array<double, 3>& lower) {
  const std::array<double, 3> upper = three(text, "the domain's upper corner");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (upper.at(axis) > lower.at(axis)) continue;
    throw text.error(cat("the domain's upper corner has ", upper.at(axis), " along ", axis_name(axis),
                         ", and must be above that of its lower corner, ", lower.at(axis), "; the header is damaged"));
  }
  return upper;
}

/// Throws if the cell size of level 0 is not the domain's size divided by its number of cells. The tolerance grows
/// with the corners, because large corners with few digits leave their difference uncertain.
void require_domain_size(const PlotfileText& text, const AmrexHeader& header, const std::array<double, 3>& upper) {
  const AmrexLevelHeader& level = header.levels.front();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto cells = static_cast<double>(cells_along(level.domain, axis));
    const double lo = header.corner.at(axis);
    const double hi = upper.at(axis);
    const double expected = hi / cells - lo / cells;
    const double slack = kDigitsSlack * (std::fabs(hi) / cells + std::fabs(lo) / cells);
    if (std::fabs(level.spacing.at(axis) - expected) <= slack) continue;
    throw text.error(cat("the size of level 0's cells along ", axis_name(axis), " is ", level.spacing.at(axis),
                         ", and must be ", expected, ", as the domain reaches from ", lo, " to ", hi, " and has ",
                         cells_along(level.domain, axis), " cells there; the header is damaged"));
  }
}

void require_refined_size(const PlotfileText& text, const AmrexHeader& header, std::size_t number) {
  const AmrexLevelHeader& level = header.levels[number];
  const std::array<std::int64_t, 3> ratio{level.ratio.x, level.ratio.y, level.ratio.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double coarse = header.levels[number - 1].spacing.at(axis);
    const double expected = coarse / static_cast<double>(ratio.at(axis));
    if (std::fabs(level.spacing.at(axis) - expected) <= kDigitsSlack * expected) continue;
    throw text.error(cat("the size of level ", number, "'s cells along ", axis_name(axis), " is ",
                         level.spacing.at(axis), ", and must be ", expected, ", that of level ", number - 1, ", ",
                         coarse, ", by the ratio ", ratio.at(axis), "; the header is damaged"));
  }
}

void read_cell_sizes(PlotfileText& text, AmrexHeader& header, const std::array<double, 3>& upper) {
  for (std::size_t i = 0; i < header.levels.size(); ++i) {
    std::array<double, 3>& spacing = header.levels[i].spacing;
    spacing = three(text, "the size of a level's cells");
    for (const double s : spacing) {
      if (!(s > 0)) throw text.error(cat("the size of a level's cells has ", s, ", and must be above 0"));
    }
    if (i == 0) {
      require_domain_size(text, header, upper);
    } else {
      require_refined_size(text, header, i);
    }
  }
}

/// Returns `path` if it stays inside the plotfile; throws Error(input) otherwise.
std::string inner_path(const PlotfileText& text, const std::string& path) {
  bool inside = !path.empty() && path.front() != '/';
  for (const std::string& part : split(path, '/')) inside = inside && !part.empty() && part != "..";
  if (inside && std::none_of(path.begin(), path.end(), [](unsigned char c) { return c < ' '; })) return path;
  throw text.error(cat(in_quotes(path), " should be the path of a level's cells, Level_0/Cell; the header is damaged"));
}

void read_level(PlotfileText& text, std::size_t number, AmrexHeader& header) {
  AmrexLevelHeader& level = header.levels[number];
  const auto last = static_cast<std::int64_t>(number);
  text.integer_in("a level's number", last, last);
  level.boxes = text.integer_in("a level's number of boxes", 1, std::numeric_limits<std::int32_t>::max());
  text.skip_word("a level's time");
  text.skip_word("a level's step");
  // The boxes' edges in world coordinates, two numbers for each axis, are skipped: Cell_H has the boxes in cells.
  for (std::int64_t i = 0; i < level.boxes * 6; ++i) text.skip_word("an edge of a box");
  text.next_byte();
  level.cells = inner_path(text, text.rest_of_line());
  for (std::size_t i = 0; i < number; ++i) {
    if (header.levels[i].cells != level.cells) continue;
    throw text.error(cat(in_quotes(level.cells), " is the path of the cells of level ", number, " and of level ", i,
                         "; the header is damaged"));
  }
}

}  // namespace

bool begins_as_amrex_header(std::string_view text) {
  text = text.substr(0, text.find_first_of("\r\n"));
  const std::size_t version = text.find("-V");
  if (version == 0 || version == std::string_view::npos || version + 2 >= text.size()) return false;
  return is_digit(text[version + 2]) && std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(version),
                                                    [](char c) { return is_letter(c) || is_digit(c); });
}

AmrexHeader parse_amrex_header(PlotfileText& text) {
  AmrexHeader header;
  text.next_byte();
  const std::string version = text.rest_of_line();
  if (!begins_as_amrex_header(version)) {
    throw text.error(cat(in_quotes(version), " should be the name and version of a plotfile, HyperCLaw-V1.1"));
  }
  header.components = component_names(text);
  const std::int64_t dimensions = text.integer("the number of dimensions");
  if (dimensions != 3) throw text.unsupported(cat("the plotfile is ", dimensions, "-D", PlotfileText::kThreeAxesOnly));
  header.time = text.real("the time");
  header.levels.resize(static_cast<std::size_t>(text.integer_in("the finest level", 0, kMostLevels - 1)) + 1);
  header.corner = three(text, "the domain's lower corner");
  const std::array<double, 3> upper = upper_corner(text, header.corner);
  read_domains(text, header);
  for (std::size_t i = 0; i < header.levels.size(); ++i) text.skip_word("a level's step");
  text.rest_of_line();
  read_cell_sizes(text, header, upper);
  const std::int64_t coordinates = text.integer("the kind of coordinates");
  if (coordinates != 0) {
    throw text.unsupported(cat("the coordinates are ",
                               coordinates == 1   ? "cylindrical"
                               : coordinates == 2 ? "spherical"
                                                  : cat("of kind ", coordinates),
                               "; only Cartesian ones can be read"));
  }
  text.skip_word("the width of the boundary");
  for (std::size_t i = 0; i < header.levels.size(); ++i) read_level(text, i, header);
  return header;
}

}  // namespace weir
