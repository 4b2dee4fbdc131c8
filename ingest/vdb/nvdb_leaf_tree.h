// A NanoVDB grid in a file as a tree of leaves. Read by pread and not by a
// mapping: a file that is cut or rewritten meanwhile is an error, not a signal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "format/nanovdb/nvdb_grid.h"
#include "ingest/files/input_file.h"
#include "ingest/vdb/leaf_source.h"

namespace weir {

/// Inner nodes of a file, those used last in memory. Thread-safe.
class NvdbNodes {
 public:
  using Node = std::shared_ptr<const std::vector<std::byte>>;
  /// What is kept, in bytes; nodes that readers still hold are not counted.
  static constexpr std::uint64_t kLimit = std::uint64_t{48} << 20U;

  /// Of the bytes [begin, end) of `file`, which must outlive the object.
  NvdbNodes(InputFile& file, std::uint64_t begin, std::uint64_t end) : file_(file), begin_(begin), end_(end) {}

  /// The `bytes` bytes at offset `at` of the file. `from` is where the file says so. Throws Error(input) where they do
  /// not lie in the grid, and as InputFile::read_buffered.
  Node read(std::uint64_t at, std::uint64_t bytes, std::uint64_t from);

  /// Throws Error(input) where the `bytes` at `at` do not lie in the grid.
  void check(std::uint64_t at, std::uint64_t bytes, std::uint64_t from) const;

  std::uint64_t end() const { return end_; }

 private:
  using Known = std::list<std::pair<std::uint64_t, Node>>;

  InputFile& file_;
  std::uint64_t begin_;
  std::uint64_t end_;
  std::mutex mutex_;
  Known nodes_;  ///< the last one used first
  std::map<std::uint64_t, Known::iterator> places_;
  std::uint64_t held_ = 0;
};

/// `grid`, which is not packed (packed_tree.h), is a view of what `file` held when it was opened, and is looked at
/// during this call only; `cached` tells that its pages are in memory already.
std::unique_ptr<LeafTree> make_nvdb_leaf_tree(std::unique_ptr<InputFile> file, const NvdbGrid& grid, bool cached);

}  // namespace weir
