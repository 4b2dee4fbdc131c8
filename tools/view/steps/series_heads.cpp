#include "tools/view/steps/series_heads.h"

#include <utility>

#include "format/base/error.h"
#include "tools/view/base/file_identity.h"
#include "tools/view/base/finite_range.h"

namespace weir {
namespace {

// Of a file whose head names no finite range. Cells that the file does not have would be made of all of its voxels.
std::optional<MinMax> range_beside_head(const std::string& path) {
  try {
    const NvdbFile file(path);
    if (const auto range = certified_range(file)) return range;
    if (has_macrocells(file.grid())) return finite_range(MacrocellGrid(file.grid(), kMacrocell));
  } catch (const Error&) {  // said when its turn comes
  }
  return std::nullopt;
}

}  // namespace

bool SeriesHeads::look_at(const std::string& path) {
  const std::string identity = file_identity(path);  // before it is read: one that takes its place is another
  const auto known = read_.find(path);
  if (known != read_.end() && known->second == identity) return true;
  SeriesSummary next = summary_;
  next.range.reset();
  try {
    add_to_summary(next, path);
  } catch (const Error&) {  // said when its turn comes
    return false;
  }
  std::optional<MinMax> range = next.range ? next.range : range_beside_head(path);
  if (range && summary_.range) widen(*range, *summary_.range);
  next.range = range ? range : summary_.range;
  summary_ = std::move(next);
  read_[path] = identity;
  return true;
}

}  // namespace weir
