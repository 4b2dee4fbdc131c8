// weir's own volumes as inputs: their bytes are checked against the certificate (sidecar) that lies beside them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "format/base/message.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// The callbacks by which a caller watches and stops the check.
struct DamageWatch {
  Notice notice;                                     ///< told if there is a sidecar that does not describe the file
  std::function<void(std::uint64_t bytes)> started;  ///< called before `bytes` are read
  std::function<void(std::uint64_t done_bytes)> advanced;  ///< may throw, which stops the check
};

/// Reads the whole .nvdb file at `path`. Throws Error(input) if its digest differs from the digest in `certificate`,
/// its sidecar, and Error(io) if it cannot be read.
void refuse_damaged(const std::string& path, const Sidecar& certificate, const DamageWatch& watch);

/// Checks the file at `path` in the same way against the sidecar that lies beside it. Without a sidecar nothing is
/// read.
void refuse_damaged(const std::string& path, const DamageWatch& watch);

}  // namespace weir
