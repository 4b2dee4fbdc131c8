// All checks of a volume and its sidecar, as `weir verify` makes them.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "format/base/trace.h"
#include "tools/verify/volume_check.h"

namespace weir {

/// What a caller can watch and stop; called from the calling thread.
struct VerificationWatch {
  std::function<void(const std::string& pass, std::uint64_t total_bytes)> pass_started;
  std::function<void(std::uint64_t done_bytes)> pass_advanced;
  const std::atomic<bool>* cancel = nullptr;
  Trace* trace = nullptr;  ///< gets the passes, and what each thread decodes and hashes in them
};

/// Checks the .nvdb at `path` and the sidecar beside it: structure, checksum, digest, and what one says of the other.
/// What is missing or makes no sense is a check that failed. Throws Error(io) where a file is there and cannot be read,
/// which says nothing of what it holds, and Error(interrupted) when cancelled.
std::vector<VolumeCheck> verify_volume(const std::string& path, const VerificationWatch& watch);

}  // namespace weir
