#include "format/nanovdb/nvdb_header.h"

#include <cmath>
#include <limits>
#include <string_view>

#include "format/layout/nanovdb_layout.h"
#include "format/nanovdb/nvdb_bytes.h"

namespace weir {
namespace {

// Newer files have "NanoVDB2" for the file and "NanoVDB1" for the grid.
constexpr std::uint64_t kMagicGridNew = nvdb::kMagic + (std::uint64_t{1} << 56U);
constexpr std::uint64_t kMagicFileNew = nvdb::kMagic + (std::uint64_t{2} << 56U);
// The offsets in nvdb::meta count from the file's start; this returns the offset from the grid's meta record.
constexpr std::uint64_t in_record(std::uint64_t field) { return field - nvdb::kFileHeaderBytes; }

// The most grids in a file, so that the list of a hostile file stays small.
constexpr std::size_t kMaxGrids = 4096;

constexpr std::array<const char*, 23> kTypeNames{"unknown", "float", "double",  "int16",     "int32",      "int64",
                                                 "Vec3f",   "Vec3d", "Mask",    "Half",      "uint32",     "bool",
                                                 "RGBA8",   "Fp4",   "Fp8",     "Fp16",      "FpN",        "Vec4f",
                                                 "Vec4d",   "Index", "OnIndex", "IndexMask", "OnIndexMask"};

std::string type_text(std::uint32_t type) {
  return type < kTypeNames.size() ? cat(type, " (", kTypeNames[type], ")") : cat(type);
}

bool supported(std::uint32_t type) {
  return type == static_cast<std::uint32_t>(GridType::float32) ||
         (type >= static_cast<std::uint32_t>(GridType::fp4) && type <= static_cast<std::uint32_t>(GridType::fpn));
}

void check_version(const NvdbBytes& bytes, std::uint64_t offset, std::uint32_t version) {
  const std::uint32_t major = version >> 21U;
  if (major == nvdb::kMajorVersion) return;
  const std::string remedy = major > nvdb::kMajorVersion ? cat("read it with a newer weir, or write it with NanoVDB ",
                                                               nvdb::kMajorVersion, ".x")
                                                         : "write the file again with a current NanoVDB";
  bytes.fail(offset, "NanoVDB version ", nvdb_version_text(version), " but only major version ", nvdb::kMajorVersion,
             " can be read; ", remedy);
}

void check_codec(const NvdbBytes& file, std::uint64_t offset, std::uint16_t codec) {
  if (codec == 0) return;
  constexpr std::array<const char*, 3> kNames{"none", "zip", "blosc"};
  const std::string name = codec < kNames.size() ? kNames[codec] : "unknown";
  file.fail(offset, "the grid is compressed, codec ", codec, " (", name,
            "); write it uncompressed with nanovdb_convert (to .vdb and back, without --zip and --blosc)");
}

std::uint64_t stored_bytes(const NvdbBytes& file, const NvdbRecord& record) {
  return file.get<std::uint64_t>(record.meta + in_record(nvdb::meta::kFileSize));
}

// Returns the meta records of the segment at `segment`, with the offsets of the grids behind them.
std::vector<NvdbRecord> read_segment(const NvdbBytes& file, std::uint64_t segment) {
  if (!file.holds(segment, nvdb::kFileHeaderBytes)) {
    file.fail(file.size(), "the file ends after ", file.size() - segment, " bytes, inside the NanoVDB header of ",
              nvdb::kFileHeaderBytes, " bytes; is it complete?");
  }
  const auto magic = file.get<std::uint64_t>(segment);
  if (magic == kMagicGridNew) {
    file.fail(segment, "a raw grid without file header (magic NanoVDB1); write it with nanovdb::io::writeGrid");
  }
  if (magic != nvdb::kMagic && magic != kMagicFileNew) {
    file.fail(segment, "magic number 0x", hex(magic), " is not NanoVDB0 or NanoVDB2; not a NanoVDB file");
  }
  check_version(file, segment + 8, file.get<std::uint32_t>(segment + 8));
  const auto grids = file.get<std::uint16_t>(segment + 12);
  if (grids == 0) file.fail(segment + 12, "the file holds 0 grids");
  std::vector<NvdbRecord> records;
  std::uint64_t at = segment + nvdb::kFileHeaderBytes;
  for (unsigned i = 0; i < grids; ++i) {
    if (!file.holds(at, nvdb::kFileMetaBytes)) {
      file.fail(file.size(), "the file ends inside the meta data of grid ", i, " of ", grids, "; is it complete?");
    }
    records.push_back({segment, at, 0});
    const auto name_bytes = file.get<std::uint32_t>(at + in_record(nvdb::meta::kNameSize));
    if (!file.holds(at + nvdb::kFileMetaBytes, name_bytes)) {
      file.fail(at + in_record(nvdb::meta::kNameSize), "a grid name of ", name_bytes,
                " bytes reaches beyond the file's ", file.size(), "; is it complete?");
    }
    at += nvdb::kFileMetaBytes + name_bytes;
  }
  for (NvdbRecord& record : records) {
    record.grid = at;
    if (__builtin_add_overflow(at, stored_bytes(file, record), &at)) at = std::numeric_limits<std::uint64_t>::max();
  }
  return records;
}

std::array<double, 3> load3(const NvdbBytes& grid, std::uint64_t offset) {
  return {grid.get<double>(offset), grid.get<double>(offset + 8), grid.get<double>(offset + 16)};
}

}  // namespace

std::string nvdb_version_text(std::uint32_t version) {
  return cat(version >> 21U, '.', (version >> 10U) & 2047U, '.', version & 1023U);
}

std::vector<NvdbRecord> first_nvdb_segment(std::span<const std::byte> file, const std::string& path) {
  return read_segment(NvdbBytes(file, 0, path), 0);
}

std::vector<NvdbRecord> all_nvdb_segments(std::span<const std::byte> bytes, const std::string& path) {
  const NvdbBytes file(bytes, 0, path);
  std::vector<NvdbRecord> all;
  for (std::uint64_t end = 0; end < bytes.size();) {
    const auto records = read_segment(file, end);
    all.insert(all.end(), records.begin(), records.end());
    if (all.size() > kMaxGrids) file.fail(end, "the file holds more than ", kMaxGrids, " grids; it is damaged");
    const std::uint64_t last = stored_bytes(file, records.back());
    // Only the last grid can be truncated; opening it reports the error.
    if (!file.holds(records.back().grid, last)) break;
    end = records.back().grid + last;
  }
  return all;
}

std::string nvdb_grid_name(std::span<const std::byte> file, const NvdbRecord& record) {
  const std::byte* const meta = file.data() + record.meta;
  const auto bytes = load<std::uint32_t>(meta + in_record(nvdb::meta::kNameSize));
  const std::string_view field(reinterpret_cast<const char*>(meta + nvdb::kFileMetaBytes), bytes);
  return std::string(field.substr(0, field.find('\0')));
}

NvdbHeader read_nvdb_header(std::span<const std::byte> bytes, const std::string& path, const NvdbRecord& record) {
  const NvdbBytes file(bytes, 0, path);
  const auto meta = [&](std::uint64_t field) { return record.meta + in_record(field); };
  check_codec(file, record.segment + 14, file.get<std::uint16_t>(record.segment + 14));
  check_codec(file, meta(nvdb::meta::kCodec), file.get<std::uint16_t>(meta(nvdb::meta::kCodec)));
  NvdbHeader header;
  header.grid_offset = record.grid;
  header.grid_bytes = file.get<std::uint64_t>(meta(nvdb::meta::kGridSize));
  const std::uint64_t stored = stored_bytes(file, record);
  if (header.grid_bytes < nvdb::kRootTilesOffset) {
    file.fail(meta(nvdb::meta::kGridSize), "a grid of ", header.grid_bytes, " bytes, smaller than its fixed head of ",
              nvdb::kRootTilesOffset);
  }
  if (stored != header.grid_bytes) {
    file.fail(meta(nvdb::meta::kFileSize), "an uncompressed grid of ", header.grid_bytes, " bytes stored in ", stored);
  }
  if (!file.holds(header.grid_offset, header.grid_bytes)) {
    file.fail(meta(nvdb::meta::kGridSize), "a grid of ", header.grid_bytes, " bytes at byte ", header.grid_offset,
              " reaches beyond the file's ", bytes.size(), "; is it complete?");
  }
  const NvdbBytes grid(bytes.subspan(header.grid_offset, header.grid_bytes), header.grid_offset, path);
  const auto magic = grid.get<std::uint64_t>(nvdb::grid::kMagic);
  if (magic != nvdb::kMagic && magic != kMagicGridNew) {
    grid.fail(nvdb::grid::kMagic, "grid magic number 0x", hex(magic), " is not NanoVDB0 or NanoVDB1");
  }
  header.version = grid.get<std::uint32_t>(nvdb::grid::kVersion);
  check_version(grid, nvdb::grid::kVersion, header.version);
  if (const auto size = grid.get<std::uint64_t>(nvdb::grid::kGridSize); size != header.grid_bytes) {
    grid.fail(nvdb::grid::kGridSize, "the grid says ", size, " bytes, the file's meta data ", header.grid_bytes);
  }
  const auto type = grid.get<std::uint32_t>(nvdb::grid::kGridType);
  if (!supported(type)) {
    grid.fail(nvdb::grid::kGridType, "grid type ", type_text(type),
              " is not supported; use a float, Fp4, Fp8, Fp16 or FpN grid");
  }
  if (const auto said = file.get<std::uint32_t>(meta(nvdb::meta::kGridType)); said != type) {
    file.fail(meta(nvdb::meta::kGridType), "the meta data says grid type ", type_text(said), ", the grid ",
              type_text(type));
  }
  header.type = static_cast<GridType>(type);
  header.name = nvdb_grid_name(bytes, record);
  header.has_min_max = (grid.get<std::uint32_t>(nvdb::grid::kFlags) & nvdb::grid::kFlagMinMax) != 0;
  header.voxel_size = load3(grid, nvdb::grid::kVoxelSize);
  for (std::size_t i = 0; i < 9; ++i) header.matrix[i] = grid.get<double>(nvdb::grid::kMap + 88 + 8 * i);
  header.world_origin = load3(grid, nvdb::grid::kMap + 232);  // the map's vec as double
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(header.voxel_size[axis] > 0) || !std::isfinite(header.voxel_size[axis])) {
      grid.fail(nvdb::grid::kVoxelSize + 8 * axis, "voxel size ", header.voxel_size[axis],
                " is not positive and finite");
    }
    if (!std::isfinite(header.world_origin[axis])) {
      grid.fail(nvdb::grid::kMap + 232 + 8 * axis, "world origin ", header.world_origin[axis], " is not finite");
    }
  }
  return header;
}

}  // namespace weir
