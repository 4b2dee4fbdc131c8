// GPUDirect Storage: reads from the disk to the device without host memory, by NVIDIA's cuFile library if it is
// installed.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "gpu/cuda/load/copy_task.h"

namespace weir {

struct CuFile;

/// Uses libcufile.so.0, which is looked up at run time: weir neither links it nor needs its headers. Opening its
/// driver takes long, so keep the object for the next load. cuFile writes its own log: cufile.log in the working
/// directory, unless CUFILE_LOGFILE_PATH names another file.
class DirectStorage {
 public:
  /// Returns true if the kernel module of GPUDirect Storage is loaded. Without it cuFile works too, through host
  /// memory.
  static bool offered();
  /// Returns nothing, with the reason in `refusal`, if the library is missing, is too old or finds no driver.
  static std::optional<DirectStorage> open(std::string& refusal);

  /// Uses functions that were looked up already.
  explicit DirectStorage(std::shared_ptr<const CuFile> library) : library_(std::move(library)) {}

  /// Reads `task.chunk_bytes` at a time from `task.threads` threads, until a read is refused. The outcome's refusal
  /// says if cuFile does not read from the file system. Throws Error(input, io, interrupted).
  CopyOutcome copy(const CopyTask& task) const;

 private:
  std::shared_ptr<const CuFile> library_;
};

}  // namespace weir
