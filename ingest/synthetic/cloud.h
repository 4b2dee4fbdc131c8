// A cumulus-like density: a heap of ellipsoids whose surface and inside are
// broken up by band-limited noise.
#pragma once

#include <memory>

#include "ingest/synthetic/field.h"

namespace weir {

/// density = s / (s + 1/2) with s = min(e, 0.45) + n > 0, otherwise exactly +0; e is the largest of
/// 1 - q over the ellipsoids (q = 1 on their surface), n noise of standard deviation 0.34. Values in
/// [0, 1), 60 to 90 % of them zero in volumes of 64^3 and more; tiles that cannot hold density cost
/// next to nothing.
std::unique_ptr<SyntheticField> make_cloud(const SyntheticOptions& options);

}  // namespace weir
