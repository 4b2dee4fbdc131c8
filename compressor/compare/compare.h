// The exact error of a NanoVDB file against its source, streaming both. With the encoder, whose certificate it judges,
// it shares the decoder of leaves and the sums over one leaf (leaf_difference.h).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "compressor/leaf/certificate.h"
#include "format/base/index.h"
#include "format/base/trace.h"
#include "format/nanovdb/nvdb_grid.h"
#include "ingest/source/volume_source.h"

namespace weir {

struct CompareOptions {
  std::uint64_t block_bytes = std::uint64_t{64} << 20U;  ///< float32 bytes of a block; two are held at a time
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(std::uint64_t done_bytes)> progress;  ///< float32 bytes of the source, of volume * 4
  /// Called, by any thread, when some tens of MiB of the grid may have become resident, or in stream_pairs
  /// `page_bytes`; a mapped file lets them go.
  std::function<void()> release_pages;
  std::uint64_t page_bytes = std::uint64_t{32} << 20U;
  Trace* trace = nullptr;  ///< gets a "read" and a "compare" of each block
};

struct Comparison {
  std::uint64_t voxels = 0;
  std::uint64_t finite = 0;               ///< source voxels that are finite
  std::uint64_t nonfinite_decoded = 0;    ///< of those, such that read NaN or infinite: the error is over the others
  std::uint64_t nonfinite = 0;            ///< source voxels that are NaN or infinite, or hold no data
  std::uint64_t missing = 0;              ///< those that hold no data
  std::uint64_t different = 0;            ///< finite source voxels that do not read bit for bit
  std::uint64_t nonfinite_different = 0;  ///< the same of those that are not finite: replaced, or dropped
  std::uint64_t missing_different = 0;    ///< and of those that hold no data
  std::uint64_t zeros = 0;                ///< source voxels that are 0
  std::uint64_t zeros_lost = 0;           ///< those that read another value
  std::optional<MinMax> range;            ///< of the finite source voxels
  std::optional<Index3> max_abs_at;       ///< of those with the largest error the first in x-fastest order; none for 0
  Certificate error;                      ///< lossless: different = 0, whatever became of what is not finite
  ConversionLoss loss;                    ///< of the source's values to float32
};

/// Compares every voxel of the source. Results depend on neither block size nor threads: squared
/// errors are summed in double in 16 lanes within a leaf and exactly between leaves.
/// Throws Error(input) where the grid's index bounding box is not the source's domain, and what
/// reading the source throws; Error(interrupted) when cancelled.
Comparison compare_volumes(VolumeSource& source, const NvdbGrid& grid, const std::string& grid_path,
                           const CompareOptions& options);

}  // namespace weir
