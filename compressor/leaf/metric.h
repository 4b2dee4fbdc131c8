// The metric that decides which leaves a budget is spent on.
#pragma once

namespace weir {

/// sse: the squared error saved (rate-distortion). The others are the paper's distances from a brick's value range
/// [lo, hi] to the background B (Zellmann et al., EGPGV 2025). closest: min(|lo - B|, |hi - B|). farthest:
/// max(|lo - B|, |hi - B|). median: |(lo + hi) / 2 - B|.
enum class Metric { sse, farthest, closest, median };

}  // namespace weir
