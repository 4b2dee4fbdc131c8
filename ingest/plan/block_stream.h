// The two ways to work on a volume block by block. From a device: while one block
// is being worked on, the next is being read by a thread of its own. From memory:
// each worker reads what it works on, so that a copy never leaves its core's cache.
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
  ConversionLoss loss;                ///< of reading it
  const BlockParts* parts = nullptr;  ///< where the values are not those of all voxels but these parts'
  const HeldLeaves* held = nullptr;   ///< where nothing was read: `values` are anything
};

/// stream_blocks or work_in_place.
enum class Reading { ahead, in_place };

struct StreamOptions {
  const std::atomic<bool>* cancel = nullptr;  ///< set by another thread or a signal handler
  /// Called on the calling thread after each block with the voxels done and the voxels of all boxes.
  std::function<void(std::int64_t done, std::int64_t total)> progress;
  /// Where given, called on the calling thread while no work is in progress, with the number of boxes, from the first
  /// on, whose work is done: after each block, or in place after each 256 MiB of them, which then are also what a set
  /// `cancel` waits for, so that it loses nothing.
  std::function<void(std::size_t boxes_done)> at_rest;
  Trace* trace = nullptr;  ///< gets a "read" of each box
  /// Blocks that are read ahead come in parts where their voxels repeat each other, and unread where their leaves lie
  /// in memory.
  bool in_parts = false;
  /// Of blocks that are read ahead, with the one that is worked on: two of the largest in any case, and up to eight.
  /// Blocks take longer and shorter: where more of them wait, neither reading nor work waits for the other as often.
  std::uint64_t buffer_bytes = 0;
};

/// Throws Error(interrupted) where `cancel` is set.
void throw_if_cancelled(const StreamOptions& options);

/// Reads each box and calls `work` on the calling thread, in the order of `boxes`; as many buffers of
/// the largest box's size exist as `options.buffer_bytes` holds. An exception of either side ends both and is rethrown;
/// a set `cancel`, looked at before and after each block's work, throws Error(interrupted) once the reads
/// in progress have ended. Returns the loss summed over all boxes.
ConversionLoss stream_blocks(VolumeSource& source, std::span<const Box> boxes, const StreamOptions& options,
                             const std::function<void(const Block&)>& work);

/// The same for a source that is in memory: TBB's workers read each box themselves, into a buffer of the
/// largest box's size per worker, and call `work` on it at once. Calls of `work` run concurrently and in
/// any order, and may not use TBB themselves; `progress` is called by one thread at a time.
ConversionLoss work_in_place(VolumeSource& source, std::span<const Box> boxes, const StreamOptions& options,
                             const std::function<void(const Block&)>& work);

}  // namespace weir
