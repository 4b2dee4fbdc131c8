// A NanoVDB file mapped read-only, with its validated grid. Owns the mapping.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "format/nvdb_grid.h"

namespace weir {

class NvdbFile {
 public:
  /// Maps and validates. Throws Error(input) for a missing, empty or invalid file.
  explicit NvdbFile(const std::string& path);
  ~NvdbFile();
  NvdbFile(NvdbFile&& other) noexcept;
  NvdbFile& operator=(NvdbFile&&) = delete;
  NvdbFile(const NvdbFile&) = delete;
  NvdbFile& operator=(const NvdbFile&) = delete;

  const std::string& path() const { return path_; }
  const NvdbGrid& grid() const { return grid_; }
  std::span<const std::byte> bytes() const { return mapping_; }

 private:
  std::string path_;
  std::span<const std::byte> mapping_;
  NvdbGrid grid_;
};

}  // namespace weir
