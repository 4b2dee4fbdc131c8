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

namespace weir {
namespace {

struct VolumeHead {
  Box box;
  float background = 0;
  MinMax range;
};

// Reads a few pages, however many nodes there are: of a series of thousands nobody waits for more. Those of the head
// are brought into the page cache first: where they are missed in the mapping, the system reads megabytes around them.
VolumeHead read_head(const std::string& path) {
  const FileMapping file(path, ".nvdb");
  std::array<std::byte, 2 * nvdb::kPage> head;
  file.read(0, std::span(head).first(std::min(head.size(), file.bytes().size())));
  const NvdbHeader header = read_nvdb_header(file.bytes(), path, first_nvdb_segment(file.bytes(), path).front());
  const NvdbBytes grid(file.bytes().subspan(header.grid_offset, header.grid_bytes), header.grid_offset, path);
  const auto root = [&](std::uint64_t field) { return grid.get<float>(nvdb::kRootOffset + field); };
  return {read_nvdb_tree_head(grid, header.type).bbox,
          root(nvdb::root::kBackground),
          {root(nvdb::root::kMin), root(nvdb::root::kMax)}};
}

std::string described(const std::string& path, const Box& box) {
  const Index3 e = box.extent();
  return cat(path, " has ", e.x, " x ", e.y, " x ", e.z, " voxels from ", box.lo.x, ",", box.lo.y, ",", box.lo.z);
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
  const VolumeHead head = read_head(path);
  if (!summary.box) {
    summary.box = head.box;
    summary.first = described(path, head.box);
  } else if (summary.difference.empty() && !(head.box == *summary.box)) {
    summary.difference = cat(summary.first, ", ", described(path, head.box));
  }
  add_values(summary, head.background, head.range);
}

void add_values(SeriesSummary& summary, float background, const MinMax& range) {
  if (!summary.background && std::isfinite(background)) summary.background = background;
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
