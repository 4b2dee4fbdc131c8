// A NanoVDB grid in a mapped file as a tree of leaves.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "format/file_mapping.h"
#include "format/nvdb_grid.h"
#include "ingest/vdb/leaf_source.h"

namespace weir {

/// Which pages of a mapping are resident counts as the process's memory: this keeps count, and gives all back where
/// they grow beyond a limit. Thread-safe.
class MappedPages {
 public:
  /// What may be resident, in bytes.
  static constexpr std::uint64_t kLimit = std::uint64_t{64} << 20U;

  explicit MappedPages(const FileMapping& mapping);

  /// Counts `bytes` at `first`, which lie in the mapping.
  void touch(const std::byte* first, std::size_t bytes);
  /// Counts bytes whose place is not known, each time anew.
  void touch(std::uint64_t bytes);

 private:
  /// What the kernel maps around a page that is looked at: fault_around_bytes.
  static constexpr std::uint64_t kGranule = 65536;

  const FileMapping& mapping_;
  std::vector<std::atomic<bool>> resident_;  ///< per granule
  std::atomic<std::uint64_t> bytes_{0};
};

/// `mapping` is what `grid` lies in; `cached` tells that its pages are in memory already.
std::unique_ptr<LeafTree> make_nvdb_tree(FileMapping mapping, NvdbGrid grid, bool cached);

}  // namespace weir
