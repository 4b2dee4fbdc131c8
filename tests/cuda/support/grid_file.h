// Writes .nvdb files for tests of loading. The grid lies at a page boundary, as weir writes it, or anywhere, as in
// foreign files, with or without padding at its end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "format/layout/nanovdb_layout.h"
#include "tests/stock/test_grid.h"

namespace weir::test {

struct GridFileOptions {
  std::uint64_t grid_offset = nvdb::kPage;  ///< at least 256
  std::uint64_t tail_bytes = 0;             ///< bytes of padding, 0xEE each
};

/// Writes a float32 grid of edge^3 voxels to `path`. No two leaves are equal.
inline void write_grid_file(const std::string& path, int edge, const GridFileOptions& options = {}) {
  const Box box{{0, 0, 0}, Index3{edge, edge, edge}};
  const TestGrid stock(box, [](const Index3& i) { return static_cast<float>(i.x + 512 * (i.y + 512 * i.z) + 1); });
  const std::vector<std::byte> file(stock.grid().bytes().begin(), stock.grid().bytes().end());
  const std::uint64_t offset = stock.grid().grid_offset();

  std::vector<std::byte> bytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(offset));
  bytes.resize(options.grid_offset);  // padding after the name
  bytes.insert(bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(offset), file.end());
  bytes.resize(bytes.size() + options.tail_bytes, std::byte{0xEE});
  const auto put = [&bytes](std::uint64_t at, auto value) { std::memcpy(bytes.data() + at, &value, sizeof value); };
  const std::uint64_t grid_bytes = bytes.size() - options.grid_offset;
  put(nvdb::meta::kNameSize, static_cast<std::uint32_t>(options.grid_offset - nvdb::kNameOffset));
  put(nvdb::meta::kGridSize, grid_bytes);
  put(nvdb::meta::kFileSize, grid_bytes);
  put(options.grid_offset + nvdb::grid::kGridSize, grid_bytes);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace weir::test
