// Reads the values of one component from FABs, a bounded number of bytes at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ingest/amrex/fab_files.h"
#include "ingest/amrex/level_cover.h"
#include "ingest/amrex/plotfile.h"
#include "ingest/amrex/range_check.h"
#include "ingest/plan/staging.h"
#include "ingest/source/stored_value.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// Thread-safe. Needs kStagingBytes of memory besides the callers' buffers.
class FabReader {
 public:
  /// `plotfile` must outlive this object. `notice` is for RangeCheck.
  FabReader(const Plotfile& plotfile, std::size_t component, DirectIo mode, Notice notice);

  /// Reads the values of `parts` into `values`, which covers `box`, x fastest, after `mapping`. All parts are of one
  /// FAB and lie in `box`, a box of cells of level `wanted`. A cell of a coarser level gives its value to all cells
  /// in it. The returned loss counts the values that are written. Rows of the FAB that lie near each other are read
  /// together.
  ConversionLoss read(std::size_t wanted, std::span<const CoverPart> parts, const Box& box, const ValueMapping& mapping,
                      std::span<float> values);

  std::uint64_t bytes_read() const { return files_.bytes_read(); }

 private:
  const Plotfile& plotfile_;
  std::size_t component_;
  FabFiles files_;
  RangeCheck check_;
  StagingPool staging_;
};

}  // namespace weir
