// Checks whether the values of FABs lie in the ranges that Cell_H states. A mismatch shows a plotfile that mixes
// files of two runs or two steps. No result depends on these ranges, so a mismatch is a warning and not an
// error.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "format/base/message.h"
#include "ingest/amrex/plotfile.h"

namespace weir {

/// Gives at most one notice. Thread-safe.
class RangeCheck {
 public:
  /// Checks one component of `plotfile`, which was opened with RangesKept::of_boxes and must outlive this object. The
  /// thread that finds the first value outside calls `notice`, only once. Nothing is checked if `notice` is empty or
  /// Cell_H states no ranges.
  RangeCheck(const Plotfile& plotfile, std::size_t component, Notice notice);

  /// Checks stored values of one FAB, in the byte layout of its file. The notice names `file`.
  void look_at(std::size_t level, std::uint32_t fab, const std::string& file, std::span<const std::byte> values);

 private:
  const Plotfile& plotfile_;
  std::size_t component_;
  Notice notice_;
  std::atomic<bool> looks_;  ///< true until a notice is given
};

}  // namespace weir
