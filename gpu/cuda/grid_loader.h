// From a .nvdb file to the device, by the fastest way that the system allows.
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

/// Below this a plain copy is done before page-locking has begun.
inline constexpr std::uint64_t kSmallGrid = 32ULL << 20U;
/// Threads of the machine from which on the pinned ring is faster than page-locking the file's own pages. On 16 cores
/// and an H200 it reached 0.93 of the device's rate, page-locking 0.30 to 0.54 (docs/performance.md); each thread of
/// the ring brings about 8 GB/s, of 55.
inline constexpr unsigned kThreadsForRing = 8;

/// The ways to try for a cached grid of that many bytes, the fastest first.
std::vector<LoadPath> load_paths(std::uint64_t bytes, unsigned hardware_threads);

struct LoadOptions {
  /// Where set, only this way is tried, and its refusal is Error(io) with the reason. Otherwise direct_storage where
  /// the system has it and the file is not in the page cache, then load_paths.
  std::optional<LoadPath> only = std::nullopt;
  std::vector<LoadPath> order = {};           ///< to try instead of those of load_paths; empty: those
  std::uint64_t chunk_bytes = 128ULL << 20U;  ///< of the file page-locked, or read, at a time by each thread
  int threads = 2;                            ///< that populate and page-lock chunks
  /// Leaves the grid in host memory, page-locked, where kernels read it over the bus: for grids larger than the
  /// device. The file's own pages are locked, all of them; where that is refused, or a foreign file has its grid at an
  /// offset that is no multiple of 32, a copy in page-locked memory serves (reported as pinned_ring).
  bool zero_copy = false;
  /// A packed grid too, whose voxels are not in its tree: the caller decodes its blocks (packed/block_decoder.h).
  bool packed = false;
  const std::atomic<bool>* cancel = nullptr;  ///< looked at before every chunk
};

/// A grid that the device can read. Move only.
class DeviceGrid {
 public:
  /// The device's address of the grid's first byte: a multiple of 256, with zero_copy of 32.
  const std::byte* data() const { return data_; }
  /// NvdbGrid::data_bytes(): without the padding at the tail.
  std::uint64_t bytes() const { return report_.bytes; }
  const LoadReport& report() const { return report_; }
  /// Of device memory that it holds: of a buffer that is larger, all.
  std::uint64_t device_bytes() const { return buffer_.capacity(); }
  /// Gives the memory to another load, which ends this grid.
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
  // One that is in `buffer`.
  DeviceGrid(DeviceBuffer&& buffer, const LoadReport& report)
      : data_(buffer.data()), report_(report), buffer_(std::move(buffer)) {}
  void move_to_device(CopyTask& task, const std::vector<LoadPath>& paths, DeviceBuffer& buffer);
  void stay_in_host_memory(const CopyTask& task, const std::optional<LoadPath>& only);

  const std::byte* data_ = nullptr;
  LoadReport report_;
  DeviceBuffer buffer_;
  std::optional<ZeroCopyRange> host_;  ///< with zero_copy
};

/// Copies the first grid of `file` to the current device, into `buffer` where that is large enough, after the work
/// queued in `stream`, null: the legacy default stream; the copy is complete when it returns. On a throw the caller
/// still owns `buffer`. With options.zero_copy `file` must outlive the grid.
///
/// The file must not change meanwhile: a truncation, or a write that the file's time shows, is an Error(input) and
/// never a signal; a write through another mapping of it may go unnoticed, and the grid is then no longer the one that
/// was validated. Throws Error(input) for a packed grid unless options.packed (see expand/expanded_grid.h), Error(io)
/// where the device has no room or fails, Error(interrupted).
DeviceGrid load_grid(const NvdbFile& file, DeviceBuffer&& buffer, const LoadOptions& options = {},
                     cudaStream_t stream = nullptr);

}  // namespace weir
