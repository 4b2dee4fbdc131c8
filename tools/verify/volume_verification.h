// Runs all checks of `weir verify` on a volume and its sidecar.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "format/base/trace.h"
#include "tools/verify/volume_check.h"

namespace weir {

/// Callbacks with which a caller watches and stops the verification; called from the calling thread.
struct VerificationWatch {
  std::function<void(const std::string& pass, std::uint64_t total_bytes)> pass_started;
  std::function<void(std::uint64_t done_bytes)> pass_advanced;
  const std::atomic<bool>* cancel = nullptr;
  Trace* trace = nullptr;  ///< receives the passes, and what each thread decodes and hashes
};

/// Checks the .nvdb at `path` and the sidecar beside it: structure, checksum, digest, and whether the two agree.
/// Missing or invalid content is a failed check. Throws Error(io) if an existing file cannot be read, because that
/// says nothing about its content, and Error(interrupted) when cancelled.
std::vector<VolumeCheck> verify_volume(const std::string& path, const VerificationWatch& watch);

}  // namespace weir
