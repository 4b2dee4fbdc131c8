// The git commit from which this program was built, for the sidecar's `weir.commit`.
#pragma once

#include <string>

namespace weir {

/// Returns the first 12 digits of the commit's hash, or an empty text if weir was built outside a git checkout. The
/// function has a file of its own, so that a new commit recompiles nothing else.
std::string build_commit();

}  // namespace weir
