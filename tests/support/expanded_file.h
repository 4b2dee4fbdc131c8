// Puts a file's head before the bytes of an expanded grid, so that readers of files can open it.
#pragma once

#include <cstring>
#include <span>

#include "format/base/little_endian.h"
#include "format/nanovdb/expanded_tree.h"
#include "tests/support/packed_grid.h"

namespace weir::test {

/// Returns the file of `grid`, which was expanded from the file `packed`.
inline PackedBytes expanded_file(std::span<const std::byte> packed, std::span<const std::byte> grid, GridType type) {
  PackedBytes file(packed.begin(), packed.begin() + nvdb::kPage);
  file.insert(file.end(), grid.begin(), grid.end());
  const std::span<std::byte> head(file);
  const auto copy = [&](std::uint64_t to, std::uint64_t from, std::size_t bytes) {
    std::memcpy(file.data() + to, file.data() + nvdb::kPage + from, bytes);
  };
  store(head, nvdb::meta::kGridSize, std::uint64_t{grid.size()});
  store(head, nvdb::meta::kFileSize, std::uint64_t{grid.size()});
  store(head, nvdb::meta::kGridType, static_cast<std::uint32_t>(type));
  store(head, nvdb::meta::kBlindCount, std::uint16_t{1});
  copy(nvdb::meta::kNodeCount, nvdb::kTreeOffset + nvdb::tree::kNodeCount, 12);
  copy(nvdb::meta::kTileCount, nvdb::kTreeOffset + nvdb::tree::kTileCount, 12);
  copy(nvdb::meta::kVoxelCount, nvdb::kTreeOffset + nvdb::tree::kVoxelCount, 8);
  return file;
}

}  // namespace weir::test
