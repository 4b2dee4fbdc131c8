// Chooses round numbers along the axes of a chart.
#pragma once

#include <string>
#include <vector>

namespace weir {

/// Returns the smallest step of 1, 2 or 5 times a power of ten of which at most `most` fit into `range`. Both are > 0.
double tick_step(double range, int most);

/// Returns multiples of one tick_step, from the last at or below `lo` to the first at or above `hi`; at least two. lo
/// <= hi, both finite.
std::vector<double> even_ticks(double lo, double hi);

/// Returns ticks for a logarithmic axis: 1, 2 and 5 times powers of ten, or only powers of ten if there would be more
/// than ten ticks. They go from the last at or below `lo` to the first at or above `hi`; at least two. 0 < lo <= hi,
/// both finite.
std::vector<double> decade_ticks(double lo, double hi);

/// Returns the multiples 1 to 9 of powers of ten inside [lo, hi]. 0 < lo <= hi, both finite.
std::vector<double> minor_decade_ticks(double lo, double hi);

/// Returns the tick's number with enough digits to tell it from ticks one `step` (>= 0) away: "0.25", "1.2e-05", "0".
std::string tick_text(double tick, double step);

}  // namespace weir
