#include "ingest/vdb/nvdb_source.h"

#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_mapping.h"
#include "format/layout/nanovdb_layout.h"
#include "format/leaf/leaf_decode.h"
#include "format/nanovdb/nvdb_checksum.h"
#include "format/nanovdb/nvdb_grid.h"
#include "ingest/files/input_file.h"
#include "ingest/headers/header_text.h"
#include "ingest/headers/named_choice.h"
#include "ingest/source/extent.h"
#include "ingest/values/axis_placement.h"
#include "ingest/vdb/grid_class.h"
#include "ingest/vdb/grid_placement.h"
#include "ingest/vdb/nvdb_leaf_tree.h"
#include "ingest/vdb/packed_tree.h"

namespace weir {
namespace {

std::array<Vector3, 3> steps_of(const NvdbGrid& grid) {
  const auto m = grid.matrix();
  return {{{m[0], m[3], m[6]}, {m[1], m[4], m[7]}, {m[2], m[5], m[8]}}};
}

GridClass stored_class_of(const NvdbGrid& grid) {
  return grid_class_stored(weir::load<std::uint32_t>(grid.data().data() + nvdb::grid::kGridClass));
}

/// One of a file's grids. volume.obstacle says why the grid cannot be opened.
struct GridCandidate {
  NamedVolume volume;
  NvdbRecord record;
  std::optional<NvdbGrid> grid;
};

GridCandidate open_candidate(const FileMapping& mapping, const std::string& path, const NvdbRecord& record) {
  GridCandidate candidate{{nvdb_grid_name(mapping.bytes(), record), {}}, record, {}};
  try {
    candidate.grid = NvdbGrid::open(mapping.bytes(), path, record);
    if (!placeable(steps_of(*candidate.grid), candidate.grid->world_origin())) {
      candidate.volume.obstacle = "its map is not finite or has a voxel size of 0";
    }
  } catch (const Error& error) {
    candidate.volume.obstacle = reason_of(error, path);
  }
  return candidate;
}

// Numbers several grids of one name as OpenVDB's tools do.
void number_equal_names(std::vector<GridCandidate>& all) {
  std::map<std::string, std::size_t> count;
  for (const GridCandidate& candidate : all) ++count[candidate.volume.name];
  std::map<std::string, std::size_t> next;
  for (GridCandidate& candidate : all) {
    std::string& name = candidate.volume.name;
    if (count[name] > 1) name = cat(name, '[', next[name]++, ']');
  }
}

std::vector<GridCandidate> candidates_of(const FileMapping& mapping, const std::string& path) {
  std::vector<GridCandidate> all;
  for (const NvdbRecord& record : all_nvdb_segments(mapping.bytes(), path)) {
    all.push_back(open_candidate(mapping, path, record));
  }
  number_equal_names(all);
  return all;
}

std::size_t choose(const std::vector<GridCandidate>& there, const std::string& path, const std::string& wanted) {
  // If the file has only one grid, the error is the grid's own obstacle.
  if (there.size() == 1 && wanted.empty() && !there[0].volume.obstacle.empty()) {
    throw Error(ErrorKind::input, cat(path, ": ", there[0].volume.obstacle));
  }
  std::vector<NamedVolume> volumes;
  for (const GridCandidate& candidate : there) volumes.push_back(candidate.volume);
  return choose_volume(path, "grid", volumes, wanted);
}

}  // namespace

bool recognises_nvdb(std::string_view path, std::span<const std::byte> head) {
  const std::string_view begin(reinterpret_cast<const char*>(head.data()), head.size());
  return begin.starts_with("NanoVDB") || lower_case(path).ends_with(".nvdb");
}

std::unique_ptr<VolumeSource> open_nvdb(const std::string& path, const SourceOptions& options) {
  refuse_index(path, options);
  auto file = std::make_unique<InputFile>(path, DirectIo::off);
  const FileMapping mapping(path, ".nvdb");  // to choose and check a grid; its values are read otherwise
  auto candidates = candidates_of(mapping, path);
  const GridCandidate& chosen = candidates[choose(candidates, path, options.dataset)];
  const NvdbGrid& grid = *chosen.grid;
  const Box domain = grid.index_bbox();
  const std::string where = cat(path, ": grid ", in_quotes(chosen.volume.name));
  if (domain.empty()) throw Error(ErrorKind::input, cat(where, " has no active voxel; nothing to convert"));
  checked_volume_bytes(domain.extent(), sizeof(float), where);
  const bool has_checksum = grid.head_checksum() != static_cast<std::uint32_t>(nvdb::kNoChecksum);
  if (options.notice && has_checksum && computed_head_checksum(grid) != grid.head_checksum()) {
    options.notice(compose(where, " has another head than its checksum is of: the file may be damaged; weir verify ",
                           "and nanovdb_validate say what of it"));
  }

  SourceInfo info;
  info.path = path;
  info.format = "nanovdb";
  info.dataset = chosen.volume.name;
  info.extent = domain.extent();
  info.index_origin = domain.lo;
  info.grid_class = stored_class_of(grid);
  info.background = background_to_keep(info.grid_class, static_cast<double>(grid.background()));
  options.complete(info.mapping);
  const AxisPlacement placement = place_grid(steps_of(grid), grid.world_origin(), domain);
  info.spacing = placement.spacing;
  info.origin = placement.origin;
  info.details.orientation = placement.orientation;
  info.file_bytes = file->size();
  info.mtime_ns = file->mtime_ns();
  info.files = {file->state()};
  const bool cached = file->looks_cached();
  auto tree = grid.packed() != nullptr ? make_packed_tree(std::move(file), grid, cached)
                                       : make_nvdb_leaf_tree(std::move(file), grid, cached);
  return make_leaf_source(std::move(tree), std::move(info));
}

std::vector<DatasetInfo> list_nvdb(const std::string& path, const SourceOptions&) {
  const FileMapping mapping(path, ".nvdb");
  std::vector<DatasetInfo> list;
  for (const GridCandidate& candidate : candidates_of(mapping, path)) {
    DatasetInfo info;
    info.name = candidate.volume.name;
    info.obstacle = candidate.volume.obstacle;
    info.layout = "NanoVDB grid";
    if (candidate.grid) {
      const NvdbGrid& grid = *candidate.grid;
      info.type = cat(grid_type_name(grid.type()), grid.packed() != nullptr ? " packed" : "");
      const std::string_view grid_class = grid_class_name(stored_class_of(grid));
      if (!grid_class.empty()) info.attributes.emplace_back("class", grid_class);
      describe_box(grid.index_bbox(), info);
      if (info.obstacle.empty()) {
        describe_placement(place_grid(steps_of(grid), grid.world_origin(), grid.index_bbox()), info);
      }
      info.attributes.emplace_back("leaves", cat(grid.node_counts()[0]));
      info.attributes.emplace_back("memory", format_bytes(grid.data_bytes()));
    }
    list.push_back(std::move(info));
  }
  return list;
}

}  // namespace weir
