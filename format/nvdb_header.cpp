#include "format/nvdb_header.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "format/nanovdb_layout.h"
#include "format/nvdb_bytes.h"

namespace weir {
namespace {

// Newer files have "NanoVDB2" for the file and "NanoVDB1" for the grid.
constexpr std::uint64_t kMagicGridNew = nvdb::kMagic + (std::uint64_t{1} << 56U);
constexpr std::uint64_t kMagicFileNew = nvdb::kMagic + (std::uint64_t{2} << 56U);
// The file's constants count from the file's start, the meta data of a grid from its record.
constexpr std::uint64_t in_record(std::uint64_t field) { return field - nvdb::kFileHeaderBytes; }

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
  if (version >> 21U != nvdb::kMajorVersion) {
    bytes.fail(offset, "NanoVDB version ", nvdb_version_text(version), " but only major version ", nvdb::kMajorVersion,
               " can be read; write the file again with a current NanoVDB");
  }
}

void check_codec(const NvdbBytes& file, std::uint64_t offset, std::uint16_t codec) {
  if (codec == 0) return;
  constexpr std::array<const char*, 3> kNames{"none", "zip", "blosc"};
  const std::string name = codec < kNames.size() ? kNames[codec] : "unknown";
  file.fail(offset, "the grid is compressed, codec ", codec, " (", name,
            "); write it uncompressed with nanovdb_convert (to .vdb and back, without --zip and --blosc)");
}

// Segment header and every meta record; returns the offset of the first grid.
std::uint64_t skip_meta(const NvdbBytes& file) {
  if (file.size() < nvdb::kFileHeaderBytes) {
    file.fail(file.size(), "the file ends after ", file.size(), " bytes, inside the NanoVDB header of ",
              nvdb::kFileHeaderBytes, " bytes; is it complete?");
  }
  const auto magic = file.get<std::uint64_t>(0);
  if (magic == kMagicGridNew) {
    file.fail(0, "a raw grid without file header (magic NanoVDB1); write it with nanovdb::io::writeGrid");
  }
  if (magic != nvdb::kMagic && magic != kMagicFileNew) {
    file.fail(0, "magic number 0x", std::hex, magic, " is not NanoVDB0 or NanoVDB2; not a NanoVDB file");
  }
  check_version(file, 8, file.get<std::uint32_t>(8));
  const auto grids = file.get<std::uint16_t>(12);
  if (grids == 0) file.fail(12, "the file holds 0 grids");
  check_codec(file, 14, file.get<std::uint16_t>(14));
  std::uint64_t at = nvdb::kFileHeaderBytes;
  for (unsigned i = 0; i < grids; ++i) {
    if (!file.holds(at, nvdb::kFileMetaBytes)) {
      file.fail(file.size(), "the file ends inside the meta data of grid ", i, " of ", grids, "; is it complete?");
    }
    const auto name_bytes = file.get<std::uint32_t>(at + in_record(nvdb::meta::kNameSize));
    if (!file.holds(at + nvdb::kFileMetaBytes, name_bytes)) {
      file.fail(at + in_record(nvdb::meta::kNameSize), "a grid name of ", name_bytes,
                " bytes reaches beyond the file's ", file.size(), "; is it complete?");
    }
    at += nvdb::kFileMetaBytes + name_bytes;
  }
  return at;
}

std::string read_name(const NvdbBytes& file) {
  const auto bytes = file.get<std::uint32_t>(nvdb::meta::kNameSize);
  const std::string_view field(reinterpret_cast<const char*>(file.at(nvdb::kNameOffset)), bytes);
  return std::string(field.substr(0, field.find('\0')));
}

std::array<double, 3> load3(const NvdbBytes& grid, std::uint64_t offset) {
  return {grid.get<double>(offset), grid.get<double>(offset + 8), grid.get<double>(offset + 16)};
}

}  // namespace

std::string nvdb_version_text(std::uint32_t version) {
  return cat(version >> 21U, '.', (version >> 10U) & 2047U, '.', version & 1023U);
}

NvdbHeader read_nvdb_header(std::span<const std::byte> bytes, const std::string& path) {
  const NvdbBytes file(bytes, 0, path);
  NvdbHeader header;
  header.grid_offset = skip_meta(file);
  check_codec(file, nvdb::meta::kCodec, file.get<std::uint16_t>(nvdb::meta::kCodec));
  header.grid_bytes = file.get<std::uint64_t>(nvdb::meta::kGridSize);
  const auto stored_bytes = file.get<std::uint64_t>(nvdb::meta::kFileSize);
  if (header.grid_bytes < nvdb::kRootTilesOffset) {
    file.fail(nvdb::meta::kGridSize, "a grid of ", header.grid_bytes, " bytes, smaller than its fixed head of ",
              nvdb::kRootTilesOffset);
  }
  if (stored_bytes != header.grid_bytes) {
    file.fail(nvdb::meta::kFileSize, "an uncompressed grid of ", header.grid_bytes, " bytes stored in ", stored_bytes);
  }
  if (!file.holds(header.grid_offset, header.grid_bytes)) {
    file.fail(nvdb::meta::kGridSize, "a grid of ", header.grid_bytes, " bytes at byte ", header.grid_offset,
              " reaches beyond the file's ", bytes.size(), "; is it complete?");
  }
  const NvdbBytes grid(bytes.subspan(header.grid_offset, header.grid_bytes), header.grid_offset, path);
  const auto magic = grid.get<std::uint64_t>(nvdb::grid::kMagic);
  if (magic != nvdb::kMagic && magic != kMagicGridNew) {
    grid.fail(nvdb::grid::kMagic, "grid magic number 0x", std::hex, magic, " is not NanoVDB0 or NanoVDB1");
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
  if (const auto meta = file.get<std::uint32_t>(nvdb::meta::kGridType); meta != type) {
    file.fail(nvdb::meta::kGridType, "the meta data says grid type ", type_text(meta), ", the grid ", type_text(type));
  }
  header.type = static_cast<GridType>(type);
  header.name = read_name(file);
  header.voxel_size = load3(grid, nvdb::grid::kVoxelSize);
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
