// Finds the exact error of a NanoVDB file against its source, streaming both, and so judges the encoder's certificate.
// It shares the decoder of leaves and the sums over one leaf (leaf_difference.h) with the encoder.
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
  std::uint64_t block_bytes = std::uint64_t{64} << 20U;  ///< float32 bytes of a block; two blocks are held at a time
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(std::uint64_t done_bytes)> progress;  ///< gets the done float32 bytes of the source, 4 per voxel
  /// Called by any thread when some tens of MiB of the grid (`page_bytes` in stream_pairs) may have become resident. A
  /// mapped file then releases its pages.
  std::function<void()> release_pages;
  std::uint64_t page_bytes = std::uint64_t{32} << 20U;
  Trace* trace = nullptr;  ///< gets a "read" and a "compare" span for each block
};

struct Comparison {
  std::uint64_t voxels = 0;
  std::uint64_t finite = 0;               ///< source voxels that are finite
  std::uint64_t nonfinite_decoded = 0;    ///< finite source voxels that decode to NaN or infinity; not part of `error`
  std::uint64_t nonfinite = 0;            ///< source voxels that are NaN or infinite, or hold no data
  std::uint64_t missing = 0;              ///< source voxels that hold no data
  std::uint64_t different = 0;            ///< finite source voxels that do not decode bit for bit
  std::uint64_t nonfinite_different = 0;  ///< `nonfinite` voxels that do not decode bit for bit: replaced or dropped
  std::uint64_t missing_different = 0;    ///< `missing` voxels that do not decode as missing
  std::uint64_t zeros = 0;                ///< source voxels that are 0
  std::uint64_t zeros_lost = 0;           ///< `zeros` voxels that decode to another value
  std::optional<MinMax> range;            ///< range of the finite source voxels
  std::optional<Index3> max_abs_at;       ///< first voxel with the largest error, x fastest; unset if the error is 0
  Certificate error;                      ///< lossless if different = 0, whatever became of non-finite voxels
  ConversionLoss loss;                    ///< loss of converting the source's values to float32
};

/// Compares every voxel of the source. Results depend on neither block size nor threads: squared errors are summed in
/// double in 16 lanes within a leaf and exactly between leaves. Throws Error(input) if the grid's index bounding box is
/// not the source's domain, what reading the source throws, and Error(interrupted) when cancelled.
Comparison compare_volumes(VolumeSource& source, const NvdbGrid& grid, const std::string& grid_path,
                           const CompareOptions& options);

}  // namespace weir
