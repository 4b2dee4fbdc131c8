// A packed grid in a remote file. It reads the file's head, the head of the packed data and of each region in use, and
// the streams of the blocks that are asked for. It reads them in few requests and keeps them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <shared_mutex>
#include <span>
#include <string>
#include <vector>

#include "format/base/index.h"
#include "format/nanovdb/nvdb_grid.h"
#include "format/remote/byte_range.h"
#include "format/remote/fetched_bytes.h"

namespace weir {

class RemoteGrid {
 public:
  /// Reads and checks the heads (remote_head.h), and throws as its functions. `path` is for messages. If blocks are
  /// missing and more than `cache` bytes are held, everything but the heads is forgotten before they are read.
  RemoteGrid(std::string path, RangeReader reader, std::uint64_t cache);

  const std::string& path() const { return path_; }
  /// Returns the grid. Callers may read its head, and the packed data that with_blocks() and with_macrocells() have
  /// read, but not its tree.
  const NvdbGrid& grid() const { return grid_; }
  std::uint64_t bytes() const { return file_->bytes().size(); }  ///< bytes of the file

  /// Returns whether the regions that `boxes` (index space) touch fit the cache; each region counts as a whole.
  bool fit_cache(std::span<const Box> boxes) const;
  /// Calls `use` while the blocks that touch `boxes` (index space) are held. For a region that is used for the first
  /// time, one request reads the head and up to three the streams; if a third of it or more is asked for, a single
  /// request reads all of it. Requests of several regions are made at once. Thread-safe. Throws as the reader and
  /// PackedData::stream(). If that or `use` throws Error(input), the data read is damaged: everything but the heads is
  /// forgotten, so that the next call reads it again.
  void with_blocks(std::span<const Box> boxes, const std::function<void()>& use);
  /// Like with_blocks(), for the grid's macrocells.
  void with_macrocells(const std::function<void()>& use);

 private:
  using Ranges = std::vector<ByteRange>;
  struct WantedRegion;

  // Returns the regions that have streams and that `boxes` touch.
  std::vector<WantedRegion> wanted_regions(std::span<const Box> boxes) const;
  // Returns the range of each chunk's head, or of the whole chunk.
  Ranges heads_of(std::span<const WantedRegion> wanted) const;
  // Returns the ranges of the groups of streams of each region; the chunk's head must be held.
  std::vector<Ranges> groups_of(std::span<const WantedRegion> wanted) const;
  bool has(std::span<const WantedRegion> wanted) const;
  void fetch(std::span<const WantedRegion> wanted);
  void make_room();
  void use_blocks(std::span<const Box> boxes, const std::function<void()>& use);
  Ranges macrocells() const;

  std::string path_;
  std::uint64_t cache_;
  std::unique_ptr<FetchedBytes> file_;
  NvdbGrid grid_;
  std::uint64_t heads_end_ = 0;  // bytes before it are always kept
  std::shared_mutex mutex_;      // shared: file_ is read; exclusive: it changes
};

}  // namespace weir
