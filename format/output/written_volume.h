// Reads the volume of a conversion that is written but has no name of its own yet.
#pragma once

#include <optional>

#include "format/io/file_system.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/nanovdb/nvdb_grid.h"

namespace weir {

class WrittenVolume {
 public:
  /// Opens `file`, which is complete and must not be written to while this object is used. Uses the file's bytes in
  /// place if they lie in memory. Otherwise maps it by its descriptor, whatever file has its path, or by its path if it
  /// has no descriptor. Throws Error(io) if it cannot be read back.
  explicit WrittenVolume(const File& file);

  const NvdbGrid& grid() const { return mapped_ ? mapped_->grid() : *held_; }
  /// Calls FileMapping::release_pages(); does nothing if the file lies in memory.
  void release_pages() const;

 private:
  std::optional<NvdbFile> mapped_;
  std::optional<NvdbGrid> held_;
};

}  // namespace weir
