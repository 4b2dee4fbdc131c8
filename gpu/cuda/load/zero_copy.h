// A range of a file that stays in page-locked host memory, where the device reads it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>

#include "gpu/cuda/load/copy_task.h"
#include "gpu/cuda/load/pinned_memory.h"
#include "gpu/cuda/load/registered_range.h"

namespace weir {

/// Page-locks the file's own pages, or a copy of them. The mapping must outlive the object.
class ZeroCopyRange {
 public:
  /// Locks the task's range; the task's target is unused. Locks the pages of the file if `own_pages` is set,
  /// otherwise a copy in page-locked memory. Returns nothing, with the reason in `refusal`, if the system does not
  /// lock the memory. Throws Error(input, io, interrupted).
  static std::optional<ZeroCopyRange> make(const CopyTask& task, bool own_pages, std::string& refusal,
                                           LoadStages& stages);

  /// Returns the device's address of the range's first byte.
  const std::byte* data() const { return data_; }

 private:
  ZeroCopyRange(std::variant<RegisteredRange, PinnedMemory> memory, const std::byte* data)
      : memory_(std::move(memory)), data_(data) {}

  std::variant<RegisteredRange, PinnedMemory> memory_;
  const std::byte* data_;
};

}  // namespace weir
