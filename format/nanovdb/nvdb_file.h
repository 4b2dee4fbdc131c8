// A NanoVDB file mapped read-only, with its validated first grid. Owns the mapping.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "format/io/file_mapping.h"
#include "format/nanovdb/nvdb_grid.h"

namespace weir {

class NvdbFile {
 public:
  /// Maps and validates `path`. Throws Error(input) for a missing, empty or invalid file, Error(io) if it cannot be
  /// read.
  explicit NvdbFile(const std::string& path) : NvdbFile(FileMapping(path, ".nvdb")) {}
  /// Validates the file that `mapping` has mapped.
  explicit NvdbFile(FileMapping mapping)
      : path_(mapping.path()),
        mapping_(std::move(mapping)),
        grid_(NvdbGrid::open(mapping_.bytes(), path_, [this] { mapping_.release_pages(); })) {}

  const std::string& path() const { return path_; }
  const NvdbGrid& grid() const { return grid_; }
  std::span<const std::byte> bytes() const { return mapping_.bytes(); }
  const FileMapping& mapping() const { return mapping_; }

 private:
  std::string path_;
  FileMapping mapping_;
  NvdbGrid grid_;
};

}  // namespace weir
