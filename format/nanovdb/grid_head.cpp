#include "format/nanovdb/grid_head.h"

#include <zlib.h>

#include <cmath>
#include <cstring>

#include "format/base/error.h"
#include "format/base/little_endian.h"
#include "format/base/text.h"
#include "format/nanovdb/macrocells.h"
#include "format/packed/packed_layout.h"

namespace weir {
namespace {

using Image = std::span<std::byte>;

// Returns NanoVDB's hash of a grid name, for look-up by name.
std::uint64_t name_key(const std::string& name) {
  std::uint64_t key = 0;
  for (const char c : name) {
    const std::uint64_t overflow = key >> 56U;
    key = key * 67 + static_cast<std::uint64_t>(static_cast<unsigned char>(c)) + overflow;
  }
  return key;
}

std::uint64_t root_key(const Index3& origin) {
  const auto part = [](std::int64_t c) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(c) >> 12U); };
  return part(origin.z) | part(origin.y) << 21U | part(origin.x) << 42U;
}

template <typename T>
void store3(Image image, std::size_t offset, const std::array<T, 3>& values) {
  for (std::size_t i = 0; i < 3; ++i) store(image, offset + i * sizeof(T), values[i]);
}

void store_index_box(Image image, std::size_t offset, const Box& box) {
  const Index3 last = box.hi - Index3{1, 1, 1};
  const std::array<std::int64_t, 6> corners{box.lo.x, box.lo.y, box.lo.z, last.x, last.y, last.z};
  for (std::size_t i = 0; i < 6; ++i) store(image, offset + 4 * i, static_cast<std::int32_t>(corners[i]));
}

// Stores the image of [lo, hi) under index * voxel_size + origin, rounded once as in NanoVDB's Map::applyMap.
void store_world_box(Image image, std::size_t offset, const GridHead& head) {
  const Box& box = head.statistics.bbox;
  const std::array<std::int64_t, 6> corners{box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z};
  for (std::size_t i = 0; i < 6; ++i) {
    store(image, offset + 8 * i, std::fma(static_cast<double>(corners[i]), head.voxel_size[i % 3], head.origin[i % 3]));
  }
}

template <typename T>
void store_map(Image image, std::size_t offset, const GridHead& head) {
  std::array<T, 9> matrix{};
  std::array<T, 9> inverse{};
  std::array<T, 3> translation{};
  for (std::size_t i = 0; i < 3; ++i) {
    matrix[4 * i] = static_cast<T>(head.voxel_size[i]);
    inverse[4 * i] = static_cast<T>(1.0 / head.voxel_size[i]);
    translation[i] = static_cast<T>(head.origin[i]);
  }
  store(image, offset, matrix);
  store(image, offset + 9 * sizeof(T), inverse);
  store(image, offset + 18 * sizeof(T), translation);
  store(image, offset + 21 * sizeof(T), T{1});  // taper, for frustums, which weir never writes
}

// Stores a count that NanoVDB keeps in 32 bits; plans never exceed 32 bits.
void store_count(Image image, std::size_t offset, std::uint64_t count) {
  if (count > 0xFFFFFFFFULL) throw Error(ErrorKind::internal, cat("a count of ", count, " is more than 32 bits hold"));
  store(image, offset, static_cast<std::uint32_t>(count));
}

void store_tree(Image tree, const GridHead& head, const TreeLayout& layout) {
  using namespace nvdb::tree;
  const std::uint64_t start = layout.grid + nvdb::kTreeOffset;
  store(tree, kLeafOffset, layout.leaves - start);
  store(tree, kLowerOffset, layout.lowers - start);
  store(tree, kUpperOffset, layout.uppers - start);
  store(tree, kRootOffset, nvdb::kTreeBytes);
  const NodeCounts& counts = layout.counts;
  const std::array<std::uint64_t, 3> nodes{counts.leaves, counts.lowers, counts.uppers};
  for (std::size_t i = 0; i < 3; ++i) {
    store_count(tree, kNodeCount + 4 * i, nodes[i]);
    store_count(tree, kTileCount + 4 * i, head.active_tiles[i]);
  }
  store(tree, kVoxelCount, head.statistics.count);
}

void store_root(Image root, const GridHead& head, const TreeLayout& layout) {
  using namespace nvdb::root;
  store_index_box(root, kBBox, head.statistics.bbox);
  store_count(root, kTableSize, head.tiles.size());
  store(root, kBackground, head.background);
  store(root, kMin, head.statistics.min);
  store(root, kMax, head.statistics.max);
  store(root, kAverage, head.statistics.average());
  store(root, kStdDev, head.statistics.deviation());
  for (std::size_t i = 0; i < head.tiles.size(); ++i) {
    const RootTile& tile = head.tiles[i];
    const Image entry = root.subspan(nvdb::kRootBytes + i * nvdb::kRootTileBytes, nvdb::kRootTileBytes);
    store(entry, kTileKey, root_key(tile.origin));
    if (tile.child != 0) {
      store(entry, kTileChild, tile.child - (layout.grid + nvdb::kRootOffset));
    } else {
      store(entry, kTileState, std::uint32_t{tile.active ? 1U : 0U});
      store(entry, kTileValue, tile.value);
    }
  }
}

void store_grid(Image grid, const GridHead& head, const TreeLayout& layout) {
  using namespace nvdb::grid;
  store(grid, kMagic, nvdb::kMagic);
  store(grid, kChecksum, nvdb::kNoChecksum);
  store(grid, kVersion, nvdb::kVersion);
  store(grid, kFlags,
        kFlagBBox | kFlagMinMax | kFlagAverage | kFlagStdDev | (head.breadth_first ? kFlagBreadthFirst : 0U));
  store(grid, kGridCount, std::uint32_t{1});
  store(grid, kGridSize, layout.grid_bytes());
  std::memcpy(grid.data() + kName, head.name.data(), head.name.size());
  store_map<float>(grid, kMap, head);
  store_map<double>(grid, kMap + 88, head);
  store_world_box(grid, kWorldBBox, head);
  store3(grid, kVoxelSize, head.voxel_size);
  store(grid, kGridClass, static_cast<std::uint32_t>(head.grid_class));
  store(grid, kGridType, static_cast<std::uint32_t>(head.type));
  store(grid, kBlindOffset, layout.blind_meta - layout.grid);
  store(grid, kBlindCount, layout.blind_records());
  store_tree(grid.subspan(nvdb::kTreeOffset, nvdb::kTreeBytes), head, layout);
  store_root(grid.subspan(nvdb::kRootOffset), head, layout);
  store(grid, kChecksum, head_checksum(grid));
}

void store_file_meta(Image file, const GridHead& head, const TreeLayout& layout) {
  namespace meta = nvdb::meta;
  store(file, 0, nvdb::kMagic);
  store(file, 8, nvdb::kVersion);
  store(file, 12, std::uint16_t{1});  // grids in this segment
  store(file, meta::kGridSize, layout.grid_bytes());
  store(file, meta::kFileSize, layout.grid_bytes());
  store(file, meta::kNameKey, name_key(head.name));
  store(file, meta::kVoxelCount, head.statistics.count);
  store(file, meta::kGridType, static_cast<std::uint32_t>(head.type));
  store(file, meta::kGridClass, static_cast<std::uint32_t>(head.grid_class));
  store_world_box(file, meta::kWorldBBox, head);
  store_index_box(file, meta::kIndexBBox, head.statistics.bbox);
  store3(file, meta::kVoxelSize, head.voxel_size);
  store(file, meta::kNameSize, static_cast<std::uint32_t>(layout.grid - nvdb::kNameOffset));
  const NodeCounts& counts = layout.counts;
  const std::array<std::uint64_t, 4> nodes{counts.leaves, counts.lowers, counts.uppers, 1};
  for (std::size_t i = 0; i < 4; ++i) store_count(file, meta::kNodeCount + 4 * i, nodes[i]);
  for (std::size_t i = 0; i < 3; ++i) {
    store_count(file, meta::kTileCount + 4 * i, head.active_tiles[i]);
  }
  // Bytes 186..187 are the blind-data count in current NanoVDB and unused in 10.0.1.
  store(file, meta::kBlindCount, static_cast<std::uint16_t>(layout.blind_records()));
  store(file, meta::kVersion, nvdb::kVersion);
  std::memcpy(file.data() + nvdb::kNameOffset, head.name.data(), head.name.size());
}

// Stores the record of an array of floats that begins `offset` bytes after the record.
void store_blind_record(Image record, std::uint64_t offset, std::uint64_t count, const std::string& name) {
  using namespace nvdb::blind;
  store(record, kDataOffset, offset);
  store(record, kCount, count);
  store(record, kElementSize, std::uint32_t{4});  // "flags" in 10.0.1, the element size in current NanoVDB
  store(record, kClass, std::uint32_t{2});        // attribute array
  store(record, kType, static_cast<std::uint32_t>(GridType::float32));
  std::memcpy(record.data() + kName, name.data(), name.size());
}

}  // namespace

std::uint32_t head_checksum(std::span<const std::byte> grid_head) {
  const auto covered = grid_head.subspan(nvdb::grid::kVersion);
  // Root tables are far below 4 GiB, but zlib counts in 32 bits, so the checksum goes piece by piece.
  uLong crc = ::crc32(0, nullptr, 0);
  for (std::size_t done = 0; done < covered.size();) {
    const std::size_t piece = std::min<std::size_t>(covered.size() - done, std::size_t{1} << 30U);
    crc = ::crc32(crc, reinterpret_cast<const Bytef*>(covered.data() + done), static_cast<uInt>(piece));
    done += piece;
  }
  return static_cast<std::uint32_t>(crc);
}

std::vector<std::byte> encode_head(const GridHead& head, const TreeLayout& layout) {
  if (head.name.empty() || head.name.size() >= nvdb::grid::kNameBytes) {
    throw Error(ErrorKind::usage, cat("grid name of ", head.name.size(), " bytes; use 1 to ", kMaxGridNameBytes));
  }
  std::vector<std::byte> file(layout.uppers);
  store_grid(Image(file).subspan(layout.grid), head, layout);
  store_file_meta(file, head, layout);
  return file;
}

std::vector<std::byte> encode_blind_records(const TreeLayout& layout) {
  std::vector<std::byte> records(layout.blind_records() * nvdb::kBlindMetaBytes);
  store_blind_record(Image(records).first(nvdb::kBlindMetaBytes), layout.blind_data - layout.blind_meta,
                     layout.counts.macrocells * 2, macrocell_name({}));
  if (layout.counts.packed_bytes > 0) {
    store_blind_record(Image(records).last(nvdb::kBlindMetaBytes),
                       layout.packed_data - layout.blind_meta - nvdb::kBlindMetaBytes,
                       layout.counts.packed_bytes / sizeof(float), packed::kRecordName);
  }
  return records;
}

}  // namespace weir
