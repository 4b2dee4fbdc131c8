// GPUDirect Storage: from the disk to the device past host memory, by NVIDIA's cuFile library where there is one.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "gpu/cuda/load/copy_task.h"

namespace weir {

struct CuFile;

/// libcufile.so.0, found when it is asked for: weir neither links it nor needs its headers. Opening its driver takes
/// long, so keep the object for the next load. cuFile writes its own log, cufile.log in the working directory unless
/// CUFILE_LOGFILE_PATH says otherwise.
class DirectStorage {
 public:
  /// True where the kernel's part of GPUDirect Storage is loaded. Without it cuFile works too, through host memory.
  static bool offered();
  /// Nothing, with the reason in `refusal`, where the library is missing, too old or finds no driver.
  static std::optional<DirectStorage> open(std::string& refusal);

  /// By functions that were found already.
  explicit DirectStorage(std::shared_ptr<const CuFile> library) : library_(std::move(library)) {}

  /// Reads `task.chunk_bytes` at a time, from task.threads threads, until one read is refused. The outcome says where
  /// the file system is not one that cuFile reads. Throws Error(input, io, interrupted).
  CopyOutcome copy(const CopyTask& task) const;

 private:
  std::shared_ptr<const CuFile> library_;
};

}  // namespace weir
