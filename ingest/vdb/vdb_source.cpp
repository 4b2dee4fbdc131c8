#include "ingest/vdb/vdb_source.h"

#include <algorithm>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/process/process_memory.h"
#include "ingest/files/input_file.h"
#include "ingest/headers/header_text.h"
#include "ingest/headers/named_choice.h"
#include "ingest/plan/conversion_bytes.h"
#include "ingest/source/extent.h"
#include "ingest/streams/file_stream.h"
#include "ingest/values/axis_placement.h"
#include "ingest/vdb/grid_class.h"
#include "ingest/vdb/grid_placement.h"
#include "ingest/vdb/openvdb_library.h"
#include "ingest/vdb/vdb_header.h"
#include "ingest/vdb/vdb_topology.h"
#include "ingest/vdb/vdb_type.h"
#include "ingest/vectors/voxel_components.h"

namespace weir {
namespace {

// Returns the grid with the tree that an instance shares, or the grid itself if it has its own tree; null if the
// shared grid is missing.
const VdbGrid* tree_owner(const VdbHeader& header, const VdbGrid& grid) {
  if (grid.parent.empty()) return &grid;
  const auto found = std::find_if(header.grids.begin(), header.grids.end(), [&](const VdbGrid& other) {
    return other.name == grid.parent && other.parent.empty() && other.tree == grid.tree;
  });
  return found == header.grids.end() ? nullptr : &*found;
}

std::string obstacle_of(const VdbHeader& header, const VdbGrid& grid) {
  if (vdb_type(grid.tree) == nullptr) {
    return cat("its type is ", in_quotes(grid.tree), ", and float, double, int32, int64, bool, mask, vec3s, ",
               "vec3d and vec3i trees of 5_4_3 can be read");
  }
  if (!grid.linear) {
    return cat("its transform is a ", in_quotes(grid.map), ", which has no voxel size; resample it to a linear one");
  }
  if (!placeable(grid.steps, grid.first)) return "its transform is not finite or has a voxel size of 0";
  if (tree_owner(header, grid) == nullptr) {
    return cat("it is an instance of ", in_quotes(grid.parent), ", which is not in the file");
  }
  return {};
}

std::int64_t components_of(const VdbGrid& grid) {
  const VdbType* const type = vdb_type(grid.tree);
  return type == nullptr ? 1 : type->components;
}

std::vector<NamedVolume> named(const VdbHeader& header, const SourceOptions& options) {
  struct Grid {
    std::string name;
    std::string obstacle;
    std::int64_t components;
  };
  std::vector<Grid> grids;
  for (const VdbGrid& grid : header.grids) grids.push_back({grid.name, obstacle_of(header, grid), components_of(grid)});
  return volumes_of_kind(grids, options.dataset, options.component);
}

std::string type_text(const VdbGrid& grid) {
  const VdbType* const type = vdb_type(grid.tree);
  if (type == nullptr) return grid.tree;
  if (type->leaf == VdbLeaf::boolean) return "bool";
  if (type->leaf == VdbLeaf::mask) return "mask";
  return cat(scalar_name(type->scalar), type->components > 1 ? cat(" x ", type->components) : "",
             grid.half && type->real ? " saved as float16" : "");
}

std::string compression_text(std::uint32_t flags) {
  std::string text;
  if ((flags & kVdbZip) != 0) text += ", zip";
  if ((flags & kVdbBlosc) != 0) text += ", blosc";
  if ((flags & kVdbActiveMask) != 0) text += ", active mask";
  return text;
}

const OpenVdbLibrary& library_for(const std::string& path) { return openvdb_library(path + ": is an OpenVDB file"); }

// A grid of integers is never a level set, and vectors have no class.
GridClass class_of(const VdbGrid& grid, const VdbType& type) {
  const GridClass called = type.components > 1 ? GridClass::unknown : grid_class_called(grid.grid_class);
  return called == GridClass::level_set && !type.real ? GridClass::unknown : called;
}

void require_memory(const std::string& where, std::uint64_t tree_bytes, const SourceOptions& options) {
  const std::uint64_t resident = resident_bytes();
  if (tree_bytes <= options.memory && resident + kConversionBytes <= options.memory - tree_bytes) return;
  throw Error(ErrorKind::usage, compose(where, ": its tree takes ", format_bytes(tree_bytes), " of memory, more than ",
                                        option("memory", format_bytes(options.memory)), " leaves; give at least ",
                                        ((resident + kConversionBytes + tree_bytes) >> 20U) + 1, "MiB"));
}

}  // namespace

bool recognises_vdb(std::string_view path, std::span<const std::byte> head) {
  constexpr std::string_view kMagic(" BDV\0\0\0\0", 8);
  const std::string_view begin(reinterpret_cast<const char*>(head.data()), head.size());
  return begin.starts_with(kMagic) || ends_with_one_of(path, kVdbEndings);
}

std::unique_ptr<VolumeSource> open_vdb(const std::string& path, const SourceOptions& options) {
  refuse_index(path, options);
  InputFile file(path, DirectIo::off);
  FileStream stream(file);
  VdbReader reader(stream, file.size(), path);
  const VdbHeader header = read_vdb_header(reader);
  const VdbGrid& grid = header.grids[choose_volume(path, "grid", named(header, options), options.dataset)];
  const VdbGrid& owner = *tree_owner(header, grid);
  const VdbType& type = *vdb_type(owner.tree);
  const VdbTopology topology = walk_vdb_tree(reader, owner, type);

  const std::string where = cat(path, ": grid ", in_quotes(grid.name));
  if (topology.active.empty()) throw Error(ErrorKind::input, cat(where, " has no active voxel; nothing to convert"));
  const VoxelComponents components = choose_components(type.components, options.component, where);
  checked_volume_bytes(topology.active.extent(), type.bytes, where);
  const OpenVdbLibrary& library = library_for(path);
  require_memory(where, library.tree_bytes(type, topology), options);

  SourceInfo info;
  info.path = path;
  info.format = "openvdb";
  info.dataset = grid.name;
  info.extent = topology.active.extent();
  info.index_origin = topology.active.lo;
  info.grid_class = class_of(grid, type);
  info.background = background_to_keep(info.grid_class, topology.background);
  info.type = type.scalar;
  info.lengths = components.count > 1 && components.choice.magnitude;
  if (components.count > 1) info.details.component = component_text(components.choice);
  options.complete(info.mapping);
  const AxisPlacement placement = place_grid(grid.steps, grid.first, topology.active);
  info.spacing = placement.spacing;
  info.origin = placement.origin;
  info.details.orientation = placement.orientation;
  info.file_bytes = file.size();
  info.mtime_ns = file.mtime_ns();
  info.files = {file.state()};
  return make_leaf_source(library.load_tree(stream, header, owner, type, where), std::move(info), components);
}

std::vector<DatasetInfo> list_vdb(const std::string& path, const SourceOptions&) {
  InputFile file(path, DirectIo::off);
  FileStream stream(file);
  VdbReader reader(stream, file.size(), path);
  const VdbHeader header = read_vdb_header(reader);
  std::vector<DatasetInfo> list;
  for (const VdbGrid& grid : header.grids) {
    DatasetInfo info;
    info.name = grid.name;
    info.type = type_text(grid);
    info.layout = cat("OpenVDB tree", compression_text(grid.compression));
    info.obstacle = obstacle_of(header, grid);
    info.components = components_of(grid);
    if (!grid.grid_class.empty()) info.attributes.emplace_back("class", grid.grid_class);
    if (info.obstacle.empty()) {
      const VdbGrid& owner = *tree_owner(header, grid);
      const VdbTopology topology = walk_vdb_tree(reader, owner, *vdb_type(owner.tree));
      describe_box(topology.active, info);
      describe_placement(place_grid(grid.steps, grid.first, topology.active), info);
      info.attributes.emplace_back("leaves", cat(topology.nodes[0]));
      info.attributes.emplace_back("memory",
                                   format_bytes(library_for(path).tree_bytes(*vdb_type(owner.tree), topology)));
    }
    list.push_back(std::move(info));
  }
  return list;
}

}  // namespace weir
