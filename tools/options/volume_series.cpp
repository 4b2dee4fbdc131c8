#include "tools/options/volume_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_mapping.h"
#include "format/io/real_path.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_bytes.h"
#include "format/nanovdb/nvdb_header.h"
#include "format/nanovdb/nvdb_tree.h"
#include "ingest/files/file_pattern.h"
#include "ingest/headers/number_pattern.h"
#include "tools/options/finite_range.h"
#include "tools/report/map_warning.h"

namespace weir {
namespace {

struct VolumeHead {
  Box box;
  float background = 0;
  MinMax range;
  std::array<double, 3> voxel_size;
  std::array<double, 3> origin;
  std::array<double, 9> matrix;
};

// Reads a few pages of the file, however many nodes it has, so that a series of thousands of files is read quickly.
// The first two pages are read into the page cache before the mapping is used: on a page fault, the system would read
// megabytes around them.
VolumeHead read_head(const std::string& path) {
  const FileMapping file(path, ".nvdb");
  std::array<std::byte, 2 * nvdb::kPage> head;
  file.read(0, std::span(head).first(std::min(head.size(), file.bytes().size())));
  const NvdbHeader header = read_nvdb_header(file.bytes(), path, first_nvdb_segment(file.bytes(), path).front());
  const NvdbBytes grid(file.bytes().subspan(header.grid_offset, header.grid_bytes), header.grid_offset, path);
  const auto root = [&](std::uint64_t field) { return grid.get<float>(nvdb::kRootOffset + field); };
  VolumeHead result{read_nvdb_tree_head(grid, header.type).bbox,
                    root(nvdb::root::kBackground),
                    kNoBounds,
                    header.voxel_size,
                    header.world_origin,
                    header.matrix};
  if (header.has_min_max) result.range = {root(nvdb::root::kMin), root(nvdb::root::kMax)};
  return result;
}

// Returns the finite range of a file when its head names none: from the sidecar or from stored macrocells. Macrocells
// are not computed here, because that would read all voxels.
std::optional<MinMax> range_beside_head(const std::string& path) {
  try {
    const NvdbFile file(path);
    if (const auto range = certified_range(file)) return range;
    if (has_macrocells(file.grid())) return MacrocellGrid(file.grid(), kMacrocell).finite_range();
  } catch (const Error&) {  // the file is reported when it is opened in its turn
  }
  return std::nullopt;
}

std::string described(const std::string& path, const Box& box) {
  const Index3 e = box.extent();
  return cat(path, " has ", e.x, " x ", e.y, " x ", e.z, " voxels from ", box.lo.x, ",", box.lo.y, ",", box.lo.z);
}

std::string described(const std::string& path, const SeriesPlace& place) {
  const auto& [size, origin] = place;
  return cat(path, " has voxels of ", size[0], " x ", size[1], " x ", size[2], " from ", origin[0], ",", origin[1], ",",
             origin[2]);
}

// Records the first difference between the first file and this file.
void note_difference(SeriesSummary& summary, const std::string& path, const VolumeHead& head) {
  const SeriesPlace place{head.voxel_size, head.origin};
  if (!summary.box) {
    summary.first = path;
    summary.box = head.box;
    summary.place = place;
  } else if (summary.difference.empty() && !(head.box == *summary.box)) {
    summary.difference = cat(described(summary.first, *summary.box), ", ", described(path, head.box));
  } else if (summary.difference.empty() && !(place == summary.place)) {
    summary.difference = cat(described(summary.first, summary.place), ", ", described(path, place));
  }
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
  VolumeHead head = read_head(path);
  if (!has_finite_ends(head.range)) head.range = range_beside_head(path).value_or(kNoBounds);
  note_difference(summary, path, head);
  if (const std::string turned = map_warning(head.matrix, head.voxel_size); !turned.empty() && summary.turned.empty()) {
    summary.turned = cat(path, ": ", turned);
  }
  if (!has_finite_ends(head.range) && summary.without_range.empty()) summary.without_range = path;
  add_values(summary, head.background, head.range);
}

void add_values(SeriesSummary& summary, float background, const MinMax& range) {
  if (!summary.background && std::isfinite(background)) summary.background = background;
  if (!has_finite_ends(range)) return;
  const MinMax known = summary.range.value_or(range);
  summary.range = MinMax{std::min(known.min, range.min), std::max(known.max, range.max)};
}

SeriesSummary summarise_series(std::span<const std::string> files) {
  SeriesSummary summary;
  for (const std::string& path : files) {
    try {
      add_to_summary(summary, path);
    } catch (const Error&) {  // the file is reported when it is opened in its turn
    }
  }
  return summary;
}

}  // namespace weir
