#include "compressor/encode/tree_writer.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <span>
#include <vector>

#include "compressor/encode/macrocell_builder.h"
#include "compressor/encode/packed_writer.h"
#include "compressor/encode/stream_pieces.h"
#include "compressor/select/region_rows.h"
#include "format/base/little_endian.h"
#include "format/nanovdb/node_image.h"

namespace weir {
namespace {

// Statistics of a node's table: first its active tiles, then its children, both in table order.
class TableStatistics {
 public:
  void add_tile(float value, std::int64_t dim, const Index3& origin) {
    tiles_.add_tile(value, static_cast<std::uint64_t>(dim * dim * dim), {origin, origin + Index3{dim, dim, dim}});
    ++active_tiles_;
  }
  void add_child(const NodeStatistics& child) { children_.push_back(child); }
  NodeStatistics total() const {
    NodeStatistics all = tiles_;
    for (const NodeStatistics& child : children_) all.add(child);
    return all;
  }
  std::uint64_t active_tiles() const { return active_tiles_; }

 private:
  NodeStatistics tiles_;
  std::vector<NodeStatistics> children_;
  std::uint64_t active_tiles_ = 0;
};

}  // namespace

// Writes lower nodes and gathers macrocells, for a few layers of regions at a time or for all regions together.
class TreeWriter::Lowers {
 public:
  Lowers(const TreeParts& parts, File& out)
      : parts_(parts),
        out_(out),
        statistics_(parts.tree.regions.size()),
        macrocells_(parts.tree.leaves.domain, parts.fill.background),
        images_(NodeImage(NodeImage::Level::lower, parts.fill.background)) {
    const NodeLattice& lattice = parts.tree.region_lattice;
    if (parts.records == nullptr) macrocells_.begin_layers(lattice.first.z, lattice.count.z);
  }

  // Adds a region. `records` are the records of its kept leaves; empty if it has no kept leaves.
  void add(std::int64_t index, std::span<const LeafRecord> records) {
    RowBuffers buffers;
    write_region(index, read_region(parts_.rows, parts_.tree.leaf_box(index), buffers), records);
  }

  // Adds the regions without kept leaves. All other regions must be added before.
  void add_rest() {
    const std::vector<Region>& regions = parts_.tree.regions;
    tbb::parallel_for(std::size_t{0}, regions.size(), [&](std::size_t i) {
      if (regions[i].leaves == 0) add(static_cast<std::int64_t>(i), {});
    });
    write_macrocells(true);
  }

  // Adds all regions, with the records of the store.
  void add_all() {
    const NodeLattice& lattice = parts_.tree.region_lattice;
    constexpr std::int64_t kRegions = 256;  // their macrocells take 1 MiB; a single layer may have more regions
    const std::int64_t layers = std::max<std::int64_t>(1, kRegions / (lattice.count.x * lattice.count.y));
    for (std::int64_t z = 0; z < lattice.count.z; z += layers) {
      const std::int64_t end = std::min(z + layers, lattice.count.z);
      macrocells_.begin_layers(lattice.first.z + z, end - z);
      for_each_region(parts_.tree, parts_.rows, {{0, 0, z}, {lattice.count.x, lattice.count.y, end}},
                      [&](std::int64_t index, const RegionRows& rows) {
                        const Region& region = parts_.tree.regions[static_cast<std::size_t>(index)];
                        std::vector<LeafRecord> room;
                        write_region(index, rows,
                                     region.leaves == 0 ? std::span<const LeafRecord>()
                                                        : parts_.records->view(region.first_leaf, region.leaves, room));
                      });
      write_macrocells(end == lattice.count.z);
    }
  }

  std::uint64_t active_tiles() const { return active_tiles_; }
  /// Returns the statistics of the lower nodes, by region.
  const std::vector<NodeStatistics>& statistics() const { return statistics_; }
  /// Returns the bounds of all decoded voxels of a packed file.
  const MinMax& decoded() const { return decoded_; }

 private:
  void write_macrocells(bool last) {
    std::int64_t first = 0;
    const std::vector<MinMax> cells = macrocells_.take_finished(last, first);
    const Index3 count = macrocells_.lattice().count;
    out_.write_at(parts_.layout.blind_data + static_cast<std::uint64_t>(first * count.x * count.y) * sizeof(MinMax),
                  std::as_bytes(std::span(cells)));
  }

  void write_region(std::int64_t index, const RegionRows& rows, std::span<const LeafRecord> records) {
    const TreeRegions& tree = parts_.tree;
    const Region& region = tree.regions[static_cast<std::size_t>(index)];
    const Index3 at = tree.region_lattice.position(index);
    RegionCells cells(tree.region_lattice.first + at);
    if (parts_.packed != nullptr) {
      write_packed(index, region, rows, records, cells);
    } else if (region.open) {
      write_lower(index, region, rows, records, cells);
    } else {
      const Upper& upper = tree.uppers[static_cast<std::size_t>(tree.upper_of(index))];
      cells.add_tile(tree.region_lattice.voxels(at), tile_value(parts_.fill, upper.open ? region.sums : upper.sums));
    }
    macrocells_.merge(cells);
  }

  void write_lower(std::int64_t index, const Region& region, const RegionRows& rows,
                   std::span<const LeafRecord> records, RegionCells& cells) {
    const TreeRegions& tree = parts_.tree;
    const LeafChoices choices = parts_.choices.read(index);
    const std::uint64_t node = parts_.layout.lower_offset(region.node);
    NodeImage& image = images_.local();
    image.reset();
    TableStatistics table;
    std::size_t next = 0;
    std::uint64_t offset = parts_.layout.leaves + region.first_byte;
    for_each_in_file_order(rows.leaf_box(), [&](const Index3& leaf) {
      const std::size_t position = tree.mask_position(leaf);
      const Box voxels = tree.leaves.voxels(leaf);
      const LeafWidth width = choices.width(position);
      if (width == LeafWidth::tile) {
        cells.add_tile(voxels, set_tile(position, leaf, rows, image, table));
        return;
      }
      const Box leaf_node = tree.leaves.node_box(leaf);
      const LeafRecord& record = records[next++];
      image.set_child(table_entry(position), offset - node);
      offset += leaf_bytes(width);
      table.add_child(active_statistics(record, leaf_node, voxels));
      cells.add_leaf(leaf_node, record);
    });
    const NodeStatistics total = table.total();
    image.set_statistics(total);
    out_.write_at(node, image.bytes());
    statistics_[static_cast<std::size_t>(index)] = total;
    active_tiles_ += table.active_tiles();
  }

  // Writes the region's directory, and its lower node if the tree has the preview.
  void write_packed(std::int64_t index, const Region& region, const RegionRows& rows,
                    std::span<const LeafRecord> records, RegionCells& cells) {
    const TreeRegions& tree = parts_.tree;
    if (!region.open) {
      write_empty_region(parts_.layout, index, region.packed_value, out_);
      cells.add_tile(tree.region_lattice.voxels(tree.region_lattice.position(index)), region.packed_value);
      widen_decoded({region.packed_value, region.packed_value});
      return;
    }
    const StreamPlaces places(parts_.packed->streams.read_allocated(index));
    write_directory(parts_.layout, tree.regions.size(), index, region, places, out_);
    MinMax decoded = kNoBounds;
    for_each_in_file_order(rows.leaf_box(), [&](const Index3& leaf) {
      const std::size_t position = tree.mask_position(leaf);
      if (places.kept(position)) {
        const LeafRecord& record = records[places.ordinal(position)];
        cells.add_leaf(tree.leaves.node_box(leaf), record);
        widen(decoded, record.bounds);
      } else {
        cells.add_tile(tree.leaves.voxels(leaf), region.packed_value);
        widen(decoded, {region.packed_value, region.packed_value});
      }
    });
    widen_decoded(decoded);
    if (parts_.packed->rule.preview) write_preview(index, region, rows, places, records);
  }

  // Writes the region's lower node in the preview: the mean of each block, and the corner leaves.
  void write_preview(std::int64_t index, const Region& region, const RegionRows& rows, const StreamPlaces& places,
                     std::span<const LeafRecord> records) {
    const TreeRegions& tree = parts_.tree;
    const std::uint64_t node = parts_.layout.lower_offset(region.node);
    NodeImage& image = images_.local();
    image.reset();
    TableStatistics table;
    for_each_in_file_order(rows.leaf_box(), [&](const Index3& leaf) {
      const std::size_t position = tree.mask_position(leaf);
      if (!is_corner(tree.leaves, leaf)) {
        set_tile(position, leaf, rows, image, table);
        return;
      }
      image.set_child(table_entry(position), corner_offset(parts_.layout, leaf) - node);
      table.add_child(
          active_statistics(records[places.ordinal(position)], tree.leaves.node_box(leaf), tree.leaves.voxels(leaf)));
    });
    const NodeStatistics total = table.total();
    image.set_statistics(total);
    out_.write_at(node, image.bytes());
    statistics_[static_cast<std::size_t>(index)] = total;
    active_tiles_ += table.active_tiles();
  }

  // Returns the entry of a leaf in the table of its lower node.
  static Index3 table_entry(std::size_t position) {
    const auto bits = static_cast<std::int64_t>(position);
    return {bits >> 8, bits >> 4 & 15, bits & 15};
  }

  // Makes a leaf a tile of its lower node; returns the tile's value.
  float set_tile(std::size_t position, const Index3& leaf, const RegionRows& rows, NodeImage& image,
                 TableStatistics& table) const {
    const NodeLattice& leaves = parts_.tree.leaves;
    const Box node = leaves.node_box(leaf);
    const LeafRow& row = rows.at(leaf);
    const float value = parts_.fill.leaf_value(row);
    const bool active = parts_.fill.active(row.valued()) && leaves.voxels(leaf) == node;
    image.set_tile(table_entry(position), value, active);
    if (active) table.add_tile(value, kLeafDim, node.lo);
    return value;
  }

  void widen_decoded(const MinMax& bounds) {
    const std::lock_guard lock(mutex_);
    widen(decoded_, bounds);
  }

  const TreeParts& parts_;
  File& out_;
  std::vector<NodeStatistics> statistics_;  // statistics of the lower nodes, by region
  MacrocellBuilder macrocells_;
  tbb::enumerable_thread_specific<NodeImage> images_;
  std::atomic<std::uint64_t> active_tiles_{0};
  std::mutex mutex_;
  MinMax decoded_ = kNoBounds;
};

namespace {

// Writes one upper node. Returns its statistics and adds the number of its active tiles to `active_tiles`.
NodeStatistics write_upper(const TreeParts& parts, std::int64_t index, const std::vector<NodeStatistics>& lowers,
                           NodeImage& image, File& out, std::uint64_t& active_tiles) {
  const TreeRegions& tree = parts.tree;
  const std::uint64_t node = parts.layout.upper_offset(tree.uppers[static_cast<std::size_t>(index)].node);
  image.reset();
  TableStatistics table;
  tree.for_each_region_of(index, [&](std::int64_t r) {
    const Region& region = tree.regions[static_cast<std::size_t>(r)];
    const Index3 entry = tree.entry_of(r);
    if (region.open) {
      image.set_child(entry, parts.layout.lower_offset(region.node) - node);
      table.add_child(lowers[static_cast<std::size_t>(r)]);
      return;
    }
    const Index3 at = tree.region_lattice.position(r);
    const float value = tile_value(parts.fill, region.sums);
    const bool active = parts.fill.active(region.sums.valued) && !tree.region_lattice.overhangs(at);
    image.set_tile(entry, value, active);
    if (active) table.add_tile(value, kLowerDim, tree.region_lattice.node_box(at).lo);
  });
  const NodeStatistics total = table.total();
  image.set_statistics(total);
  out.write_at(node, image.bytes());
  active_tiles += table.active_tiles();
  return total;
}

}  // namespace

TreeWriter::TreeWriter(const TreeParts& parts, File& out)
    : parts_(parts), out_(out), lowers_(std::make_unique<Lowers>(parts_, out)) {}
TreeWriter::~TreeWriter() = default;

void TreeWriter::add(std::int64_t region, std::span<const LeafRecord> records) { lowers_->add(region, records); }

std::uint32_t TreeWriter::finish(GridHead head) {
  Lowers& lowers = *lowers_;
  parts_.records == nullptr ? lowers.add_rest() : lowers.add_all();
  head.active_tiles = {lowers.active_tiles(), 0, 0};

  const TreeRegions& tree = parts_.tree;
  const bool has_nodes = parts_.packed == nullptr || parts_.packed->rule.preview;
  NodeImage image(NodeImage::Level::upper, parts_.fill.background);
  NodeStatistics total;
  tree.for_each_upper([&](std::int64_t u) {
    const Upper& upper = tree.uppers[static_cast<std::size_t>(u)];
    const Index3 at = tree.upper_lattice.position(u);
    RootTile tile;
    tile.origin = tree.upper_lattice.node_box(at).lo;
    if (upper.open && has_nodes) {
      tile.child = parts_.layout.upper_offset(upper.node);
      total.add(write_upper(parts_, u, lowers.statistics(), image, out_, head.active_tiles[1]));
    } else {
      tile.value = tile_value(parts_.fill, upper.sums);
      tile.active = has_nodes && parts_.fill.active(upper.sums.valued) && !tree.upper_lattice.overhangs(at);
      if (tile.active) {
        total.add_tile(tile.value, static_cast<std::uint64_t>(kUpperDim * kUpperDim * kUpperDim),
                       tree.upper_lattice.node_box(at));
        ++head.active_tiles[2];
      }
    }
    head.tiles.push_back(tile);
  });
  head.background = parts_.fill.background;
  if (parts_.packed != nullptr) {
    write_packed_head(*parts_.packed, tree, parts_.layout, out_);
    // The bounding box is the domain and the range is the range of the decoded values, whatever the tree holds of them.
    total.bbox = tree.leaves.domain;
    const MinMax& decoded = lowers.decoded();
    if (decoded.min <= decoded.max) {
      total.min = decoded.min + 0.0F;  // turns -0.0 into 0.0, because the threads decide which zero comes first
      total.max = decoded.max + 0.0F;
    }
  }
  head.statistics = total;
  out_.write_at(parts_.layout.blind_meta, encode_blind_records(parts_.layout));
  const std::vector<std::byte> bytes = encode_head(head, parts_.layout);
  out_.write_at(0, bytes);
  return load<std::uint32_t>(bytes, parts_.layout.grid + nvdb::grid::kChecksum);
}

}  // namespace weir
