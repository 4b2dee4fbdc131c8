// Two ways to work on a volume block by block. From a device: a separate thread reads the next block while the
// current one is worked on. From memory: each worker reads the block that it works on, so that the copy never leaves
// its core's cache.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>

#include "format/base/index.h"
#include "format/base/trace.h"
#include "ingest/source/volume_source.h"

namespace weir {

class BlockParts;
class HeldLeaves;

struct Block {
  std::size_t index = 0;              ///< position in the list given to stream_blocks
  Box voxels;                         ///< index space
  std::span<const float> values;      ///< x fastest over `voxels`; valid during the call only
  ConversionLoss loss;                ///< loss of reading the block
  const BlockParts* parts = nullptr;  ///< if set, `values` holds these parts' values instead of one value per voxel
  const HeldLeaves* held = nullptr;   ///< if set, nothing was read (the leaves lie in memory), and `values` is
                                      ///< undefined
};

/// How blocks are read: ahead by stream_blocks, or by work_in_place.
enum class Reading { ahead, in_place };

struct StreamOptions {
  const std::atomic<bool>* cancel = nullptr;  ///< set by another thread or a signal handler
  /// Called on the calling thread after each block, with the voxels done so far and the voxels of all boxes.
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  /// If given, called on the calling thread while no work is in progress. Gets the number of boxes, counted from the
  /// first, that are done. Reading ahead calls it after each block; in place it is called after each 256 MiB of
  /// blocks. A set `cancel` then also waits for the end of these blocks, so that no work is lost.
  std::function<void(std::size_t boxes_done)> at_rest;
  Trace* trace = nullptr;  ///< gets a "read" event for each box
  /// Blocks that are read ahead come in parts if their voxels repeat each other. They come unread if their leaves lie
  /// in memory.
  bool in_parts = false;
  /// Bytes of all buffers, with the one that is worked on. There are two to eight buffers of the largest block's size,
  /// but no more than blocks. Blocks take different times: with more of them buffered, reading and work wait for each
  /// other less often.
  std::uint64_t buffer_bytes = 0;
};

/// Throws Error(interrupted) if `cancel` is set.
void throw_if_cancelled(const StreamOptions& options);

/// Reads each box and calls `work` on the calling thread, in the order of `boxes`. There are as many buffers of the
/// largest box's size as fit `options.buffer_bytes`. An exception of either side ends both and is rethrown. A set
/// `cancel`, checked before and after each block's work, throws Error(interrupted) once the reads in progress have
/// ended. Returns the loss summed over all boxes.
ConversionLoss stream_blocks(VolumeSource& source, std::span<const Box> boxes, const StreamOptions& options,
                             const std::function<void(const Block&)>& work);

/// Does the work of stream_blocks for a source that is in memory. TBB's workers read each box themselves, into one
/// buffer of the largest box's size per worker, and call `work` on it at once. Calls of `work` run concurrently and
/// in any order, and may not use TBB themselves. `progress` is called by one thread at a time.
ConversionLoss work_in_place(VolumeSource& source, std::span<const Box> boxes, const StreamOptions& options,
                             const std::function<void(const Block&)>& work);

}  // namespace weir
