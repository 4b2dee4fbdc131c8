// Loads a .nvdb file to the device, by the fastest way that the system allows.
#pragma once

#include <cuda_runtime_api.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "format/nanovdb/nvdb_file.h"
#include "gpu/cuda/device_buffer.h"
#include "gpu/cuda/load/copy_task.h"
#include "gpu/cuda/load/load_report.h"
#include "gpu/cuda/load/zero_copy.h"

namespace weir {

/// Below this size, a plain copy ends before page-locking begins.
inline constexpr std::uint64_t kSmallGrid = 32ULL << 20U;
/// Number of hardware threads from which on the pinned ring is faster than page-locking the file's own pages. On 16
/// cores and an H200 the ring reached 0.93 of the device's rate, page-locking 0.30 to 0.54 (docs/performance.md).
/// Each thread of the ring brings about 8 GB/s of 55.
inline constexpr unsigned kThreadsForRing = 8;

/// Returns the ways to try for a cached grid of `bytes` bytes, the fastest first.
std::vector<LoadPath> load_paths(std::uint64_t bytes, unsigned hardware_threads);

struct LoadOptions {
  /// If set, only this way is tried, and a refusal is Error(io) with the reason. Otherwise direct_storage is tried if
  /// the system has it and the file is not in the page cache, then the ways of load_paths.
  std::optional<LoadPath> only = std::nullopt;
  std::vector<LoadPath> order = {};           ///< ways to try; empty: those of load_paths
  std::uint64_t chunk_bytes = 128ULL << 20U;  ///< bytes page-locked, or read, at a time by each thread
  int threads = 2;                            ///< threads that populate and page-lock chunks
  /// Leaves the grid in page-locked host memory, where kernels read it over the bus. For grids larger than the
  /// device. All of the file's own pages are locked. If this is refused, or the grid of a foreign file begins at an
  /// offset that is no multiple of 32, a copy in page-locked memory is used (reported as pinned_ring).
  bool zero_copy = false;
  /// Also loads a packed grid. Its tree has no voxels: the caller decodes its blocks (packed/block_decoder.h).
  bool packed = false;
  const std::atomic<bool>* cancel = nullptr;  ///< checked before every chunk
};

/// A grid that the device can read. Move only.
class DeviceGrid {
 public:
  /// Returns the device's address of the grid's first byte: a multiple of 256, or of 32 with zero_copy.
  const std::byte* data() const { return data_; }
  /// Returns NvdbGrid::data_bytes(), without the padding at the end.
  std::uint64_t bytes() const { return report_.bytes; }
  const LoadReport& report() const { return report_; }
  /// Returns the bytes of device memory that the grid holds. If its buffer is larger than the grid, all of it counts.
  std::uint64_t device_bytes() const { return buffer_.capacity(); }
  /// Gives the memory to another load. This grid is gone then.
  DeviceBuffer take_buffer() && {
    data_ = nullptr;
    host_.reset();
    return std::move(buffer_);
  }

 private:
  friend DeviceGrid load_grid(const NvdbFile& file, DeviceBuffer&& buffer, const LoadOptions& options,
                              cudaStream_t stream);
  friend DeviceGrid load_grid_as(const NvdbFile& file, GridType as, DeviceBuffer&& buffer, const LoadOptions& options,
                                 cudaStream_t stream);

  DeviceGrid() = default;
  // For a grid that lies in `buffer`.
  DeviceGrid(DeviceBuffer&& buffer, const LoadReport& report)
      : data_(buffer.data()), report_(report), buffer_(std::move(buffer)) {}
  void move_to_device(CopyTask& task, const std::vector<LoadPath>& paths, DeviceBuffer& buffer);
  void stay_in_host_memory(const CopyTask& task, const std::optional<LoadPath>& only);

  const std::byte* data_ = nullptr;
  LoadReport report_;
  DeviceBuffer buffer_;
  std::optional<ZeroCopyRange> host_;  ///< with zero_copy
};

/// Copies the first grid of `file` to the current device, into `buffer` if it is large enough, after the work queued
/// in `stream` (null: the legacy default stream). The copy is complete when the call returns. If it throws, the
/// caller still owns `buffer`. With options.zero_copy, `file` must outlive the grid.
///
/// The file must not change during the call. A truncation, or a write that the file's time shows, is an Error(input)
/// and never a signal. A write through another mapping of the file may go unnoticed; then the grid is not the one
/// that was validated. Throws Error(input) for a packed grid unless options.packed is set (see
/// expand/expanded_grid.h), Error(io) if the device has no room or fails, Error(interrupted).
DeviceGrid load_grid(const NvdbFile& file, DeviceBuffer&& buffer, const LoadOptions& options = {},
                     cudaStream_t stream = nullptr);

}  // namespace weir
