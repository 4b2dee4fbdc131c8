// Which commit this build of weir is of, for the sidecar's `weir.commit`.
#pragma once

#include <string>

namespace weir {

/// The first 12 digits of its hash; empty where it was built outside a git checkout. In a file of its own, so that a
/// new commit recompiles nothing else.
std::string build_commit();

}  // namespace weir
