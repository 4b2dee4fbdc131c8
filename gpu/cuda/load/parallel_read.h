// Reads a range of a file by several threads.
#pragma once

#include <cstdint>
#include <functional>

#include "gpu/cuda/load/copy_task.h"

namespace weir {

/// A piece of the file: bytes [offset, offset + bytes), counted from the task's offset.
struct FilePiece {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
};

/// Calls take(thread, piece) for all pieces of `piece_bytes` of the task's range, from `threads` threads that each
/// take the next piece. Threads are numbered 0 ... threads - 1; 0 is the caller, and the others enter its context.
/// Data that is not cached is requested from the disk ahead. After all threads have ended, throws the first failure
/// of a call, or Error(interrupted).
void for_each_piece(const CopyTask& task, std::uint64_t piece_bytes, int threads,
                    const std::function<void(int, const FilePiece&)>& take);

}  // namespace weir
