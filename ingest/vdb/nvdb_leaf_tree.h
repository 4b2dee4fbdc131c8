// Reads a NanoVDB grid in a file as a tree of leaves. Uses pread and not a mapping, so that a file that is cut or
// rewritten during the reading gives an error and not a signal.
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

/// A cache of a file's inner nodes; it keeps the most recently used nodes. Thread-safe.
class NvdbNodes {
 public:
  using Node = std::shared_ptr<const std::vector<std::byte>>;
  /// The most bytes that are kept. Nodes that readers still hold are not counted.
  static constexpr std::uint64_t kLimit = std::uint64_t{48} << 20U;

  /// Caches nodes of the bytes [begin, end) of `file`, which must outlive the object.
  NvdbNodes(InputFile& file, std::uint64_t begin, std::uint64_t end) : file_(file), begin_(begin), end_(end) {}

  /// Returns the `bytes` bytes at offset `at` of the file. `from` is the offset of the file's reference to them.
  /// Throws Error(input) if they do not lie in the grid, and the errors of InputFile::read_buffered.
  Node read(std::uint64_t at, std::uint64_t bytes, std::uint64_t from);

  /// Throws Error(input) if the `bytes` bytes at `at` do not lie in the grid.
  void check(std::uint64_t at, std::uint64_t bytes, std::uint64_t from) const;

  std::uint64_t end() const { return end_; }

 private:
  using Known = std::list<std::pair<std::uint64_t, Node>>;

  InputFile& file_;
  std::uint64_t begin_;
  std::uint64_t end_;
  std::mutex mutex_;
  Known nodes_;  ///< the most recently used node first
  std::map<std::uint64_t, Known::iterator> places_;
  std::uint64_t held_ = 0;
};

/// Returns the tree of `grid`, which is not packed (packed_tree.h). `grid` is a view of the content of `file` when it
/// was opened, and is used during this call only. `cached` says that its pages are in memory already.
std::unique_ptr<LeafTree> make_nvdb_leaf_tree(std::unique_ptr<InputFile> file, const NvdbGrid& grid, bool cached);

}  // namespace weir
