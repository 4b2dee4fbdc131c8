// Round numbers along the axes of a chart.
#pragma once

#include <string>
#include <vector>

namespace weir {

/// 1, 2 or 5 times a power of ten: the smallest such step of which at most `most` fit `range`, both > 0.
double tick_step(double range, int most);

/// Multiples of one tick_step, from the last at or below `lo` to the first at or above `hi`; at least two.
/// lo <= hi, both finite.
std::vector<double> even_ticks(double lo, double hi);

/// For a logarithmic axis: 1, 2 and 5 times powers of ten, or powers of ten alone where that would be more than
/// ten, from the last at or below `lo` to the first at or above `hi`; at least two. 0 < lo <= hi, both finite.
std::vector<double> decade_ticks(double lo, double hi);

/// The multiples of powers of ten, 1 to 9 times each, inside [lo, hi]. 0 < lo <= hi, both finite.
std::vector<double> minor_decade_ticks(double lo, double hi);

/// A tick's number with the digits that tell it from those one `step` (>= 0) away: "0.25", "1.2e-05", "0".
std::string tick_text(double tick, double step);

}  // namespace weir
