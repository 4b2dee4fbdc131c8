#include "gpu/cuda/grid_loader.h"

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/layout/nanovdb_layout.h"
#include "gpu/cuda/load/load_stream.h"
#include "gpu/cuda/load/pageable_copy.h"
#include "gpu/cuda/load/registered_copy.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/current_device.h"

namespace weir {
namespace {

constexpr std::uint64_t kLeastChunkBytes = 4096;

CopyOutcome through_ring(const CopyTask& task, std::optional<PinnedRing>& ring) {
  const std::uint64_t piece_bytes = std::min(task.chunk_bytes, PinnedRing::kPieceBytes);
  CopyOutcome outcome;
  double register_s = 0;
  if (!ring || ring->piece_bytes() != piece_bytes) {
    const StageClock clock(register_s);
    ring.reset();
    ring = PinnedRing::make(piece_bytes, PinnedRing::kThreads, outcome.refusal);
  }
  if (ring) outcome.stages = ring->copy(task);
  outcome.stages.register_s = register_s;
  return outcome;
}

CopyOutcome through_direct_storage(const CopyTask& task, std::optional<DirectStorage>& storage) {
  CopyOutcome outcome;
  if (!storage) storage = DirectStorage::open(outcome.refusal);
  return storage ? storage->copy(task) : outcome;
}

CopyOutcome copy_by(LoadPath path, const CopyTask& task, DeviceBuffer& buffer) {
  switch (path) {
    case LoadPath::registered:
      return registered_copy(task);
    case LoadPath::pinned_ring:
      return through_ring(task, buffer.ring());
    case LoadPath::direct_storage:
      return through_direct_storage(task, buffer.direct_storage());
    case LoadPath::pageable:
      break;
  }
  return pageable_copy(task);
}

std::vector<LoadPath> paths_to_try(const CopyTask& task, const LoadOptions& options) {
  if (options.only) return {*options.only};
  if (!options.order.empty()) return options.order;
  std::vector<LoadPath> paths = load_paths(task.bytes, std::thread::hardware_concurrency());
  if (DirectStorage::offered() && !task.file.cached(task.offset, task.bytes)) {
    paths.insert(paths.begin(), LoadPath::direct_storage);
  }
  return paths;
}

void add_refusal(std::string& note, LoadPath path, const std::string& refusal) {
  note += cat(note.empty() ? "" : "; ", "not ", load_path_name(path), ": ", refusal);
}

[[noreturn]] void fail_refused(const CopyTask& task, const std::string& note) {
  throw Error(ErrorKind::io, cat(task.file.path(), ": cannot be brought to the device: ", note));
}

// The tree of a packed grid holds only means, and kernels would show them without a warning.
void require_stored_voxels(const NvdbFile& file) {
  if (file.grid().packed() == nullptr) return;
  throw Error(ErrorKind::input,
              compose(file.path(), ": is packed; the CUDA loader reads float, Fp4, Fp8, Fp16 and FpN ",
                      "grids; load it as one of them, or convert it with ", option("encoding", "float")));
}

}  // namespace

std::vector<LoadPath> load_paths(std::uint64_t bytes, unsigned hardware_threads) {
  if (bytes < kSmallGrid) return {LoadPath::pageable, LoadPath::pinned_ring, LoadPath::registered};
  if (hardware_threads >= kThreadsForRing) return {LoadPath::pinned_ring, LoadPath::registered, LoadPath::pageable};
  return {LoadPath::registered, LoadPath::pinned_ring, LoadPath::pageable};
}

DeviceGrid load_grid(const NvdbFile& file, DeviceBuffer&& buffer, const LoadOptions& options, cudaStream_t stream) {
  if (!options.packed) require_stored_voxels(file);
  CopyTask task{file.mapping(), file.grid().grid_offset(), file.grid().data_bytes()};
  task.device = existing_current_device();
  const LoadStream own(stream);
  task.stream = own.get();
  task.chunk_bytes = std::max(options.chunk_bytes, kLeastChunkBytes);
  task.threads = std::max(options.threads, 1);
  task.cancel = options.cancel;

  DeviceGrid grid;
  LoadReport& report = grid.report_;
  report.bytes = task.bytes;
  report.zero_copy = options.zero_copy;
  {
    const StageClock clock(report.seconds);
    task.check_cancelled();
    task.file.check_unchanged();
    if (options.zero_copy) {
      grid.stay_in_host_memory(task, options.only);
    } else {
      buffer.reserve(task.bytes);
      grid.move_to_device(task, paths_to_try(task, options), buffer);
    }
    task.file.check_unchanged();
  }
  grid.buffer_ = std::move(buffer);
  return grid;
}

void DeviceGrid::move_to_device(CopyTask& task, const std::vector<LoadPath>& paths, DeviceBuffer& buffer) {
  task.target = buffer.data();
  for (const LoadPath path : paths) {
    const CopyOutcome outcome = copy_by(path, task, buffer);
    if (outcome.refusal.empty()) {
      report_.path = path;
      report_.stages = outcome.stages;
      data_ = buffer.data();
      return;
    }
    add_refusal(report_.note, path, outcome.refusal);
  }
  fail_refused(task, report_.note);
}

void DeviceGrid::stay_in_host_memory(const CopyTask& task, const std::optional<LoadPath>& only) {
  for (const LoadPath path : {LoadPath::registered, LoadPath::pinned_ring}) {
    if (only && *only != path) continue;
    std::string refusal;
    LoadStages stages;
    if (path == LoadPath::registered && task.offset % nvdb::kAlignment != 0) {
      refusal = cat("the grid is at byte ", task.offset, ", no multiple of ", nvdb::kAlignment);
    } else {
      host_ = ZeroCopyRange::make(task, path == LoadPath::registered, refusal, stages);
    }
    if (host_) {
      report_.path = path;
      report_.stages = stages;
      data_ = host_->data();
      return;
    }
    add_refusal(report_.note, path, refusal);
  }
  if (report_.note.empty()) add_refusal(report_.note, *only, "a grid does not stay in host memory that way");
  fail_refused(task, report_.note);
}

}  // namespace weir
