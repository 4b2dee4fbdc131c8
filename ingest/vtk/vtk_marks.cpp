#include "ingest/vtk/vtk_marks.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "format/base/text.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

struct MarkKind {
  std::string_view name;
  double unmarked;           ///< value of an ordinary point or cell
  std::string_view meaning;  ///< what any other value means
};
// vtkDataSetAttributes::GhostArrayName, its name before VTK 6.3, and vtkProbeFilter's mask.
constexpr std::array<MarkKind, 3> kMarkKinds{{{"vtkGhostType", 0, "hidden or duplicate"},
                                              {"vtkGhostLevels", 0, "duplicate"},
                                              {"vtkValidPointMask", 1, "without data"}}};

/// Returns the kind of marks called `name`; null if an array of that name is a field.
const MarkKind* mark_kind(std::string_view name) {
  for (const std::string_view folder : {"PointData/", "CellData/"}) {
    if (name.starts_with(folder)) name.remove_prefix(folder.size());
  }
  const auto* const found =
      std::find_if(kMarkKinds.begin(), kMarkKinds.end(), [&](const MarkKind& kind) { return kind.name == name; });
  return found == kMarkKinds.end() ? nullptr : found;
}

}  // namespace

bool marks_places(std::string_view name) { return mark_kind(name) != nullptr; }

std::string marks_note(const VtkArray& field, const std::vector<VtkArray>& marks) {
  if (marks_places(field)) return "";
  for (const VtkArray& array : marks) {
    const MarkKind* const kind = mark_kind(array.name);
    if (kind == nullptr || array.cells != field.cells) continue;
    if (array.range && array.range->front() == kind->unmarked && array.range->back() == kind->unmarked) continue;
    return cat("array ", in_quotes(array.name), array.range ? " marks " : " may mark ",
               field.cells ? "cells" : "points", " as ", kind->meaning,
               ", which weir does not apply: their values count as data; write NaN there where they are none");
  }
  return "";
}

}  // namespace weir
