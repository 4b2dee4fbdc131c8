#include "tests/stock/vdb_oracle.h"
#include "format/leaf/leaf_decode.h"

#include <openvdb/openvdb.h>

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "format/base/text.h"

namespace weir::test {
namespace {

struct Loaded {
  openvdb::FloatGrid::Ptr grid;
  std::string creator;
};

Loaded load(const std::string& path) {
  openvdb::initialize();
  openvdb::io::File file(path);
  file.open(false);
  const auto grids = file.getGrids();
  if (grids->size() != 1) throw std::runtime_error(cat(grids->size(), " grids"));
  return {openvdb::gridPtrCast<openvdb::FloatGrid>(grids->front()),
          file.getMetadata()->metaValue<std::string>("creator")};
}

bool same(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }

std::array<double, 3> vector(const openvdb::Vec3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

VdbFacts read_facts(const std::string& path) {
  const Loaded loaded = load(path);
  VdbFacts facts;
  facts.name = loaded.grid->getName();
  facts.creator = loaded.creator;
  facts.half = loaded.grid->saveFloatAsHalf();
  for (auto meta = loaded.grid->beginMeta(); meta != loaded.grid->endMeta(); ++meta) {
    facts.metadata[meta->first] = meta->second->str();
  }
  const auto& transform = loaded.grid->constTransform();
  const openvdb::Vec3d origin = transform.indexToWorld(openvdb::Vec3d(0, 0, 0));
  facts.origin = vector(origin);
  for (int axis = 0; axis < 3; ++axis) {
    openvdb::Vec3d unit(0, 0, 0);
    unit[axis] = 1;
    facts.steps[static_cast<std::size_t>(axis)] = vector(transform.indexToWorld(unit) - origin);
  }
  facts.map = transform.mapType();
  return facts;
}

std::string difference(const NvdbGrid& grid, const std::string& path, const std::function<float(float)>& expected) {
  const Loaded loaded = load(path);
  const openvdb::FloatTree& tree = loaded.grid->constTree();
  if (!same(tree.background(), expected(grid.background()))) return cat("background ", tree.background());
  const std::vector<openvdb::Index32> nodes = tree.nodeCount();
  for (std::size_t level = 0; level < 3; ++level) {
    if (nodes[level] != grid.node_counts()[level]) return cat(nodes[level], " nodes of level ", level);
  }
  if (tree.root().getTableSize() != grid.root_tiles()) return cat(tree.root().getTableSize(), " root entries");
  if (tree.activeVoxelCount() != grid.active_voxels()) return cat(tree.activeVoxelCount(), " active voxels");

  std::string found;
  const openvdb::tree::ValueAccessor<const openvdb::FloatTree> accessor(tree);
  std::array<float, kLeafVoxels> values{};
  grid.for_each_block([&](const GridBlock& block) {
    if (!found.empty()) return;
    const openvdb::Coord at(static_cast<int>(block.origin.x), static_cast<int>(block.origin.y),
                            static_cast<int>(block.origin.z));
    const std::string where = cat("at ", at.x(), ',', at.y(), ',', at.z());
    if (block.leaf == nullptr) {
      const int depth = block.dim == kUpperDim ? 0 : block.dim == kLowerDim ? 1 : 2;
      if (accessor.getValueDepth(at) != depth) found = cat(where, " depth ", accessor.getValueDepth(at));
      float value = 0;
      if (accessor.probeValue(at, value) != block.active) found = where + " other state of tile";
      if (!same(value, expected(block.value))) found = cat(where, " tile of ", value, ", not ", block.value);
      return;
    }
    const auto* leaf = accessor.probeConstLeaf(at);
    if (leaf == nullptr) {
      found = where + " no leaf";
      return;
    }
    grid.decode_leaf(block.leaf, values);
    for (unsigned i = 0; i < values.size(); ++i) {
      if (leaf->isValueOn(i) != leaf_active(block.leaf, i)) found = cat(where, " other state of ", i);
      if (!same(leaf->getValue(i), expected(values[i]))) found = cat(where, " value ", leaf->getValue(i), " of ", i);
    }
  });
  return found;
}

}  // namespace weir::test
