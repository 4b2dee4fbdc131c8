#include "tools/options/volume_series.h"

#include <glob.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "format/nanovdb/nvdb_file.h"

namespace weir {
namespace {

// The run of digits at the start of `text`, without leading zeros; `text` becomes what follows.
std::string_view take_number(std::string_view& text) {
  std::size_t end = 0;
  while (end < text.size() && is_digit(text[end])) ++end;
  std::string_view number = text.substr(0, end);
  text.remove_prefix(end);
  while (number.size() > 1 && number.front() == '0') number.remove_prefix(1);
  return number;
}

std::vector<std::string> matches(const std::string& pattern) {
  glob_t found{};
  const int status = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found);
  std::vector<std::string> paths(found.gl_pathv, found.gl_pathv + (status == 0 ? found.gl_pathc : 0));
  ::globfree(&found);
  if (paths.empty()) {
    throw Error(ErrorKind::input, cat(pattern, ": no file has such a name; give .nvdb files or a pattern in quotes"));
  }
  return paths;
}

std::string described(const NvdbFile& file) {
  const Box& box = file.grid().index_bbox();
  const Index3 e = box.extent();
  return cat(file.path(), " has ", e.x, " x ", e.y, " x ", e.z, " voxels from ", box.lo.x, ",", box.lo.y, ",",
             box.lo.z);
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a;
  const std::string_view whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view x = take_number(a);
      const std::string_view y = take_number(b);
      if (x.size() != y.size()) return x.size() < y.size();
      if (x != y) return x < y;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;  // "1" and "01"
}

std::vector<std::string> expand_volumes(std::span<const std::string> inputs) {
  std::vector<std::string> files;
  for (const std::string& input : inputs) {
    if (input.find_first_of("*?[") == std::string::npos || is_there(input)) {
      files.push_back(input);
    } else {
      const std::vector<std::string> found = matches(input);
      files.insert(files.end(), found.begin(), found.end());
    }
  }
  std::sort(files.begin(), files.end(), natural_less);
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

SeriesSummary summarise_series(std::span<const std::string> files) {
  SeriesSummary summary;
  std::optional<Box> box;
  std::string first;
  for (const std::string& path : files) {
    try {
      const NvdbFile file(path);
      const NvdbGrid& grid = file.grid();
      if (!box) {
        box = grid.index_bbox();
        first = described(file);
      } else if (summary.difference.empty() && !(grid.index_bbox() == *box)) {
        summary.difference = cat(first, ", ", described(file));
      }
      if (!summary.background && std::isfinite(grid.background())) summary.background = grid.background();
      const MinMax range{grid.value_min(), grid.value_max()};
      if (!std::isfinite(range.min) || !std::isfinite(range.max) || range.min > range.max) continue;
      const MinMax known = summary.range.value_or(range);
      summary.range = MinMax{std::min(known.min, range.min), std::max(known.max, range.max)};
    } catch (const Error&) {  // said when its turn comes
    }
  }
  return summary;
}

}  // namespace weir
