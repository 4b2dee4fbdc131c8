// What a budget is spent on.
#pragma once

namespace weir {

/// sse: squared error saved (rate-distortion). The others are the paper's distances from a brick's
/// value range [lo, hi] to the background B: closest min(|lo - B|, |hi - B|), farthest the max,
/// median |(lo + hi) / 2 - B| (Zellmann et al., EGPGV 2025).
enum class Metric { sse, farthest, closest, median };

}  // namespace weir
