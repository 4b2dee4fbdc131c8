#include "tools/options/volume_series.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "format/nanovdb/nvdb_file.h"
#include "ingest/files/file_pattern.h"
#include "ingest/headers/number_pattern.h"

namespace weir {
namespace {

std::string described(const NvdbFile& file) {
  const Box& box = file.grid().index_bbox();
  const Index3 e = box.extent();
  return cat(file.path(), " has ", e.x, " x ", e.y, " x ", e.z, " voxels from ", box.lo.x, ",", box.lo.y, ",",
             box.lo.z);
}

}  // namespace

std::vector<std::string> expand_volumes(std::span<const std::string> inputs) {
  std::vector<std::string> files;
  for (const std::string& input : inputs) {
    const std::string name = std::filesystem::path(input).filename().string();
    if (is_file_pattern(input)) {
      const std::vector<std::string> found = matching_files(input);
      files.insert(files.end(), found.begin(), found.end());
    } else if (NumberPattern::parse(name) && !is_there(input)) {
      for (const NumberedFile& file : numbered_files(input)) files.push_back(file.path);
    } else {
      files.push_back(input);
    }
  }
  std::sort(files.begin(), files.end(), natural_less);
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

void add_to_summary(SeriesSummary& summary, const std::string& path) {
  const NvdbFile file(path);
  const NvdbGrid& grid = file.grid();
  if (!summary.box) {
    summary.box = grid.index_bbox();
    summary.first = described(file);
  } else if (summary.difference.empty() && !(grid.index_bbox() == *summary.box)) {
    summary.difference = cat(summary.first, ", ", described(file));
  }
  if (!summary.background && std::isfinite(grid.background())) summary.background = grid.background();
  const MinMax range{grid.value_min(), grid.value_max()};
  if (!std::isfinite(range.min) || !std::isfinite(range.max) || range.min > range.max) return;
  const MinMax known = summary.range.value_or(range);
  summary.range = MinMax{std::min(known.min, range.min), std::max(known.max, range.max)};
}

SeriesSummary summarise_series(std::span<const std::string> files) {
  SeriesSummary summary;
  for (const std::string& path : files) {
    try {
      add_to_summary(summary, path);
    } catch (const Error&) {  // said when its turn comes
    }
  }
  return summary;
}

}  // namespace weir
