#include "format/nanovdb/nvdb_blind.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/macrocells.h"
#include "format/packed/packed_layout.h"

namespace weir {
namespace {

constexpr std::uint32_t kFloatType = 1;
constexpr std::uint64_t kFloatBytes = 4;
constexpr std::string_view kPackedPrefix = "weir_packed:";

// Bytes of an element by grid type as on disk; 0 if NanoVDB defines no fixed size.
constexpr std::array<std::uint64_t, 19> kElementBytes{0, 4, 8, 2, 4, 8, 12, 24, 0, 2, 4, 1, 4, 0, 0, 0, 0, 16, 32};

struct Record {
  std::uint64_t offset;  // offset of the record from the grid's start
  std::uint64_t data;    // offset of its data from the grid's start
  std::uint64_t count;
  std::uint32_t type;
  std::string_view name;
};

Record read_record(const NvdbBytes& grid, std::uint64_t offset) {
  const auto relative = grid.get<std::int64_t>(offset + nvdb::blind::kDataOffset);
  std::int64_t data = 0;
  if (__builtin_add_overflow(static_cast<std::int64_t>(offset), relative, &data) || data < 0 ||
      static_cast<std::uint64_t>(data) > grid.size()) {
    grid.fail(offset + nvdb::blind::kDataOffset, "blind data offset ", relative, " leaves the grid's ", grid.size(),
              " bytes");
  }
  const std::string_view name(reinterpret_cast<const char*>(grid.at(offset + nvdb::blind::kName)),
                              nvdb::blind::kNameBytes);
  return {offset, static_cast<std::uint64_t>(data), grid.get<std::uint64_t>(offset + nvdb::blind::kCount),
          grid.get<std::uint32_t>(offset + nvdb::blind::kType), name.substr(0, name.find('\0'))};
}

// Returns the end of the record's data.
std::uint64_t data_end(const NvdbBytes& grid, const Record& record) {
  const std::uint64_t bytes = record.type < kElementBytes.size() ? kElementBytes[record.type] : 0;
  if (bytes == 0) return grid.size();
  if (record.count > (grid.size() - record.data) / bytes) {
    grid.fail(record.offset + nvdb::blind::kCount, record.count, " elements of ", bytes,
              " bytes of blind data at grid offset ", record.data, " reach beyond the grid's ", grid.size(), " bytes");
  }
  return record.data + record.count * bytes;
}

MacrocellView read_macrocells(const NvdbBytes& grid, const Record& record, const MacrocellName& shape,
                              const Box& bbox) {
  if (record.type != kFloatType) {
    grid.fail(record.offset + nvdb::blind::kType, "macrocells of type ", record.type, " instead of float");
  }
  if (bbox.empty()) grid.fail(record.offset, "macrocells of a grid without active voxels");
  MacrocellView view{shape.cell, shape.apron, make_lattice(bbox, shape.cell), {}};
  const auto cells = static_cast<std::uint64_t>(view.lattice.size());
  if (record.count != 2 * cells) {
    grid.fail(record.offset + nvdb::blind::kCount, record.count, " values of macrocells, but ", view.lattice.count.x,
              " x ", view.lattice.count.y, " x ", view.lattice.count.z, " cells of ", shape.cell, "^3 voxels have ",
              2 * cells);
  }
  const std::byte* data = grid.at(record.data);
  if (reinterpret_cast<std::uintptr_t>(data) % alignof(MinMax) != 0) return {};
  view.cells = {reinterpret_cast<const MinMax*>(data), cells};
  return view;
}

void read_packed(const NvdbBytes& grid, const Record& record, NvdbBlindData& blind) {
  if (record.name != packed::kRecordName) {
    grid.fail(record.offset + nvdb::blind::kName, "packed data \"", record.name.substr(0, 32),
              "\", and this weir reads \"", packed::kRecordName, "\"; use a newer one");
  }
  if (record.type != kFloatType) {
    grid.fail(record.offset + nvdb::blind::kType, "packed data of type ", record.type, " instead of float");
  }
  if (blind.packed_bytes != 0) grid.fail(record.offset, "a second record of packed data");
  if (record.count == 0) grid.fail(record.offset + nvdb::blind::kCount, "packed data of 0 bytes");
  blind.packed = record.data;
  blind.packed_bytes = record.count * kFloatBytes;
}

}  // namespace

NvdbBlindData read_nvdb_blind_data(const NvdbBytes& grid, std::uint64_t tree_end, const Box& bbox) {
  const auto count = grid.get<std::uint32_t>(nvdb::grid::kBlindCount);
  NvdbBlindData blind;
  blind.end = tree_end;
  if (count == 0) return blind;
  const auto first = grid.get<std::uint64_t>(nvdb::grid::kBlindOffset);
  if (first < tree_end || !grid.holds(first, count * nvdb::kBlindMetaBytes)) {
    grid.fail(nvdb::grid::kBlindOffset, count, " blind data records at grid offset ", first,
              ", not between the last node at ", tree_end, " and the grid's end at ", grid.size());
  }
  blind.end = first + count * nvdb::kBlindMetaBytes;
  for (std::uint64_t i = 0; i < count; ++i) {
    const Record record = read_record(grid, first + i * nvdb::kBlindMetaBytes);
    blind.end = std::max(blind.end, data_end(grid, record));
    if (const auto shape = parse_macrocell_name(record.name); shape && blind.macrocells.cells.empty()) {
      blind.macrocells = read_macrocells(grid, record, *shape, bbox);
    } else if (record.name.starts_with(kPackedPrefix)) {
      read_packed(grid, record, blind);
    }
  }
  return blind;
}

}  // namespace weir
