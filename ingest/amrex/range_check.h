// Whether the values of FABs lie in the ranges that Cell_H states of them: a plotfile of files of two runs, or of two
// steps, shows there. Nothing is computed from these ranges, so that other values are worth a warning and no error.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "format/base/message.h"
#include "ingest/amrex/plotfile.h"

namespace weir {

/// Thread-safe.
class RangeCheck {
 public:
  /// Of one component of `plotfile`, which was opened with RangesKept::of_boxes and outlives the object. `notice`
  /// is called by the thread that comes upon the first value outside, and never again; where it is empty, or Cell_H
  /// states no ranges, nothing is looked at.
  RangeCheck(const Plotfile& plotfile, std::size_t component, Notice notice);

  /// Stored values of one FAB, as they lie in `file`.
  void look_at(std::size_t level, std::uint32_t fab, const std::string& file, std::span<const std::byte> values);

 private:
  const Plotfile& plotfile_;
  std::size_t component_;
  Notice notice_;
  std::atomic<bool> looks_;  ///< until something was said
};

}  // namespace weir
