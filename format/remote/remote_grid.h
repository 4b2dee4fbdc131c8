// A packed grid that lies elsewhere: its head, the head of its packed data and of each region that is looked at, and
// the streams of the blocks that are asked for are read, in few requests, and kept.
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
  /// Reads and checks the heads (remote_head.h), and throws as they. `path` is for messages. When blocks are asked for
  /// that are not there, and more than `cache` bytes are, all but the heads are forgotten first.
  RemoteGrid(std::string path, RangeReader reader, std::uint64_t cache);

  const std::string& path() const { return path_; }
  /// Its head, and of its packed data what with_blocks and with_macrocells have read, may be looked at; its tree not.
  const NvdbGrid& grid() const { return grid_; }
  std::uint64_t bytes() const { return file_->bytes().size(); }  ///< of the file

  /// Whether the regions that `boxes` (index space) touch take no more than the cache, all of each counted.
  bool fit_cache(std::span<const Box> boxes) const;
  /// Calls `use` while the blocks that touch `boxes` (index space) are there. Of a region that is looked at for the
  /// first time, one request reads the head and up to three the streams, or a single one all of it where a third or
  /// more is asked for; requests of several regions are made at once. Thread-safe. Throws as the reader and
  /// PackedData::stream. Where that or `use` throws Error(input), since what was read is damaged, all but the heads is
  /// forgotten, so that the next call reads it again.
  void with_blocks(std::span<const Box> boxes, const std::function<void()>& use);
  /// The same of the grid's macrocells.
  void with_macrocells(const std::function<void()>& use);

 private:
  using Ranges = std::vector<ByteRange>;
  struct WantedRegion;

  // The regions that have streams and that `boxes` touch.
  std::vector<WantedRegion> wanted_regions(std::span<const Box> boxes) const;
  // Of each its chunk's head, or all of it.
  Ranges heads_of(std::span<const WantedRegion> wanted) const;
  // Of each its groups of streams; its head is there.
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
  std::uint64_t heads_end_ = 0;  // what lies before is kept
  std::shared_mutex mutex_;      // shared: file_ is looked at; alone: it changes
};

}  // namespace weir
