#include "ingest/vdb/vdb_header.h"

#include <string_view>

#include "ingest/headers/header_text.h"

namespace weir {
namespace {

constexpr std::uint64_t kMagic = 0x56444220;  ///< " BDV" and four zeros
constexpr std::uint32_t kOldest = 222;        ///< the first version with masks of active values
constexpr std::uint32_t kNewest = 224;
constexpr std::size_t kUuidBytes = 36;
constexpr std::uint32_t kMaxGrids = 4096;  ///< so that a hostile file's list stays small
constexpr std::string_view kHalfSuffix = "_HalfFloat";
/// In stored names, the separator before the number that tells apart several grids of one name.
constexpr char kNumberSeparator = '\x1e';

/// Reads a map of named values; keeps only the text called `wanted`.
std::string read_metadata(VdbReader& reader, std::string_view wanted) {
  std::string kept;
  for (auto count = reader.get<std::uint32_t>(); count > 0; --count) {
    const std::string name = reader.text();
    const std::string type = reader.text();
    const auto bytes = reader.get<std::uint32_t>();
    if (name == wanted && type == "string" && bytes <= VdbReader::kMaxTextBytes) {
      kept.resize(bytes);
      if (bytes > 0) reader.read(kept.data(), bytes);
    } else {
      reader.skip(bytes);
    }
  }
  return kept;
}

Vector3 read_vector(VdbReader& reader) {
  const auto x = reader.get<double>();
  const auto y = reader.get<double>();
  const auto z = reader.get<double>();
  return {x, y, z};
}

void set_scale(const Vector3& scale, VdbGrid& grid) {
  for (std::size_t a = 0; a < 3; ++a) grid.steps[a][a] = scale[a];
  grid.linear = true;
}

// Maps.h: each map writes its parameters, and some maps also write derived values. After the map only the tree
// follows, which is not needed here, so an unknown map ends the reading.
void read_map(VdbReader& reader, VdbGrid& grid) {
  grid.map = reader.text();
  constexpr std::uint64_t kFromScale = 4 * 3 * sizeof(double);  // voxel size, inverse, its square and half of it
  if (grid.map == "UniformScaleMap" || grid.map == "ScaleMap") {
    set_scale(read_vector(reader), grid);
    reader.skip(kFromScale);
  } else if (grid.map == "TranslationMap") {
    set_scale({1, 1, 1}, grid);
    grid.first = read_vector(reader);
  } else if (grid.map == "UniformScaleTranslateMap" || grid.map == "ScaleTranslateMap") {
    grid.first = read_vector(reader);
    set_scale(read_vector(reader), grid);
    reader.skip(kFromScale);
  } else if (grid.map == "AffineMap" || grid.map == "UnitaryMap") {
    // Row vectors: world = index * M, so row a is the step along axis a and row 3 is the translation.
    for (std::size_t row = 0; row < 4; ++row) {
      (row < 3 ? grid.steps[row] : grid.first) = read_vector(reader);
      reader.get<double>();
    }
    grid.linear = true;
  }
}

// "density", separator, "1" becomes "density[1]", as OpenVDB's tools show it.
std::string shown_name(const std::string& stored) {
  const std::size_t at = stored.find(kNumberSeparator);
  return at == std::string::npos ? stored : cat(stored.substr(0, at), '[', stored.substr(at + 1), ']');
}

VdbGrid read_grid(VdbReader& reader) {
  VdbGrid grid;
  grid.name = shown_name(reader.text());
  grid.tree = reader.text();
  if (grid.tree.ends_with(kHalfSuffix)) {
    grid.half = true;
    grid.tree.resize(grid.tree.size() - kHalfSuffix.size());
  }
  grid.parent = shown_name(reader.text());
  const auto begin = reader.get<std::uint64_t>();
  reader.get<std::uint64_t>();  // of the leaves' values
  const auto end = reader.get<std::uint64_t>();
  if (begin < reader.position() || end < begin) {
    reader.fail("grid ", in_quotes(grid.name), " is to lie at bytes ", begin, " to ", end, "; the file is damaged");
  }
  reader.seek(begin);
  grid.compression = reader.get<std::uint32_t>();
  grid.grid_class = read_metadata(reader, "class");
  read_map(reader, grid);
  grid.tree_offset = reader.position();
  reader.seek(end);
  return grid;
}

}  // namespace

VdbHeader read_vdb_header(VdbReader& reader) {
  if (reader.left() < sizeof kMagic || reader.get<std::uint64_t>() != kMagic) {
    throw Error(ErrorKind::input, cat(reader.path(), ": does not begin as an OpenVDB file does"));
  }
  VdbHeader header;
  header.version = reader.get<std::uint32_t>();
  if (header.version < kOldest || header.version > kNewest) {
    reader.fail("file format ", header.version, ", and ", kOldest, " to ", kNewest,
                " can be read; write the file again with OpenVDB 10");
  }
  header.library_major = reader.get<std::uint32_t>();
  header.library_minor = reader.get<std::uint32_t>();
  if (reader.get<std::uint8_t>() == 0) {
    reader.fail("the file was written as a stream, without the grids' offsets; write it again as a file");
  }
  reader.skip(kUuidBytes);
  read_metadata(reader, {});
  const auto count = reader.get<std::uint32_t>();
  if (count > kMaxGrids) reader.fail(count, " grids, at most ", kMaxGrids, " can be read; the file is damaged");
  for (std::uint32_t i = 0; i < count; ++i) header.grids.push_back(read_grid(reader));
  return header;
}

}  // namespace weir
