#include "format/remote/remote_head.h"

#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/macrocells.h"
#include "format/nanovdb/nvdb_bytes.h"
#include "format/packed/packed_layout.h"

namespace weir {
namespace {

/// Bytes of the file's head and of the grid's, which begins at the second page.
constexpr std::uint64_t kHeadBytes = 2 * nvdb::kPage;
/// A head with larger counts is taken as damaged, so that it cannot make weir read gigabytes.
constexpr std::uint64_t kMostRootTiles = std::uint64_t{1} << 16;
constexpr std::int64_t kMostRegions = std::int64_t{1} << 24;
constexpr std::uint32_t kMostBlindRecords = 1024;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::input, cat(path, ": ", why, "; copy the file to this machine to read it"));
}

class HeadFetcher {
 public:
  HeadFetcher(FetchedBytes& file, const std::string& path)
      : file_(file),
        path_(path),
        header_(read_nvdb_header(file.bytes(), path, first_nvdb_segment(file.bytes(), path).front())),
        grid_(file.bytes().subspan(header_.grid_offset, header_.grid_bytes), header_.grid_offset, path) {}

  RemoteHead fetch() {
    const auto tiles = grid_.get<std::uint32_t>(nvdb::kRootOffset + nvdb::root::kTableSize);
    if (tiles > kMostRootTiles) refuse(path_, cat("has a root table of ", tiles, " entries"));
    need(nvdb::kRootTilesOffset, tiles * nvdb::kRootTileBytes);
    const NvdbTree tree = read_nvdb_tree_head(grid_, header_.type);
    if (tree.bbox.empty() || header_.type != GridType::float32) refuse_unpacked();
    regions_ = make_lattice(tree.bbox, kLowerDim);
    const Index3 n = regions_.count;
    if (n.x > kMostRegions || n.y > kMostRegions / n.x || n.z > kMostRegions / n.x / n.y) {
      refuse(path_, cat("has ", n.x, " x ", n.y, " x ", n.z, " regions of 128^3 voxels"));
    }
    NvdbBlindData blind = at_its_place(tree);
    if (blind.packed_bytes == 0) blind = by_its_record(tree);
    return {header_, tree, blind};
  }

 private:
  // Fetches bytes at `offset` from the grid's start. Ignores a range beyond the grid's end: the code that reads it
  // reports the error.
  void need(std::uint64_t offset, std::uint64_t bytes) {
    if (grid_.holds(offset, bytes)) file_.fetch({{header_.grid_offset + offset, bytes}});
  }
  std::uint64_t table_bytes() const {
    return static_cast<std::uint64_t>(regions_.size()) * packed::region::kEntryBytes;
  }
  [[noreturn]] void refuse_unpacked() const {
    refuse(path_, "is not packed (--encoding packed), and only packed files are read block by block");
  }

  // Looks for the packed data right behind the macrocells, where weir writes it. Returns no packed data if it is not
  // there.
  NvdbBlindData at_its_place(const NvdbTree& tree) {
    const auto records = grid_.get<std::uint64_t>(nvdb::grid::kBlindOffset);
    const NodeLattice cells = make_lattice(tree.bbox, kMacrocell);
    const auto count = static_cast<std::uint64_t>(cells.size());
    const std::uint64_t before = 2 * nvdb::kBlindMetaBytes + count * sizeof(MinMax);
    if (grid_.get<std::uint32_t>(nvdb::grid::kBlindCount) != 2 || !grid_.holds(records, before)) return {};
    const std::uint64_t at = records + before;
    if (!grid_.holds(at, packed::kRegionsOffset + table_bytes())) return {};
    need(at, packed::kRegionsOffset + table_bytes());
    const auto bytes = grid_.get<std::uint64_t>(at + packed::header::kBytes);
    const auto field = [&](std::uint64_t offset) { return grid_.get<std::uint32_t>(at + offset); };
    const bool there =
        field(packed::header::kVersion) == packed::kVersion && field(packed::header::kTableCount) == kPackedTables &&
        grid_.get<std::uint64_t>(at + packed::header::kRegions) == packed::kRegionsOffset && grid_.holds(at, bytes);
    if (!there) return {};
    const auto* const values = reinterpret_cast<const MinMax*>(grid_.at(at - count * sizeof(MinMax)));
    return {{kMacrocell, kMacrocellApron, cells, {values, count}}, at, bytes, at + bytes};
  }

  NvdbBlindData by_its_record(const NvdbTree& tree) {
    const auto records = grid_.get<std::uint32_t>(nvdb::grid::kBlindCount);
    if (records > kMostBlindRecords) refuse(path_, cat("has ", records, " records of blind data"));
    need(grid_.get<std::uint64_t>(nvdb::grid::kBlindOffset), records * nvdb::kBlindMetaBytes);
    const NvdbBlindData blind = read_nvdb_blind_data(grid_, tree.end, tree.bbox);
    if (blind.packed_bytes == 0) refuse_unpacked();
    if (blind.packed_bytes < packed::kRegionsOffset) return blind;  // read_packed_header() reports it
    need(blind.packed, packed::kRegionsOffset);
    const auto table = grid_.get<std::uint64_t>(blind.packed + packed::header::kRegions);
    if (table != packed::kRegionsOffset) refuse(path_, "has its table of regions elsewhere than behind its head");
    need(blind.packed + table, table_bytes());
    return blind;
  }

  FetchedBytes& file_;
  const std::string& path_;
  NvdbHeader header_;
  NvdbBytes grid_;
  NodeLattice regions_;
};

}  // namespace

std::unique_ptr<FetchedBytes> fetch_file_head(const std::string& path, RangeReader reader) {
  std::vector<std::byte> head(kHeadBytes);
  const ByteRange range{0, kHeadBytes};
  const std::span<std::byte> into(head);
  reader({&range, 1}, {&into, 1});
  const auto records = first_nvdb_segment(head, path);
  if (records.size() != 1) refuse(path, cat("holds ", records.size(), " grids"));
  const auto stored = load<std::uint64_t>(head.data() + nvdb::meta::kFileSize);
  std::uint64_t bytes = 0;
  if (__builtin_add_overflow(records.front().grid, stored, &bytes) || bytes < kHeadBytes ||
      records.front().grid + nvdb::kRootTilesOffset > kHeadBytes) {
    refuse(path, cat("has a grid of ", stored, " bytes at byte ", records.front().grid, ", as no packed file has it"));
  }
  auto file = std::make_unique<FetchedBytes>(bytes, std::move(reader));
  file->put(0, head);
  return file;
}

RemoteHead fetch_heads(FetchedBytes& file, const std::string& path) { return HeadFetcher(file, path).fetch(); }

}  // namespace weir
