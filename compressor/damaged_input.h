// Volumes of weir's own as inputs: their bytes against the certificate that lies beside them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "format/base/message.h"
#include "format/sidecar/sidecar.h"

namespace weir {

/// What a caller is told, and can stop.
struct DamageWatch {
  Notice notice;                                           ///< where a sidecar is there and says nothing of the file
  std::function<void(std::uint64_t bytes)> started;        ///< before that many are read
  std::function<void(std::uint64_t done_bytes)> advanced;  ///< may throw
};

/// Reads all of the .nvdb file at `path`, and throws Error(input) where its bytes are not those that `certificate`, its
/// sidecar, says. Throws Error(io) where it cannot be read.
void refuse_damaged(const std::string& path, const Sidecar& certificate, const DamageWatch& watch);

/// The same by the sidecar that lies beside it. Of a file without one nothing is known, and nothing read.
void refuse_damaged(const std::string& path, const DamageWatch& watch);

}  // namespace weir
