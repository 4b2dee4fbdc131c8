// Numbers as text without loss.
#pragma once

#include <string>

namespace weir {

/// Returns the shortest text that reads back as the same double.
std::string exact_text(double value);

/// Returns `value` in hexadecimal, "0x1.8p+1", as std::hexfloat writes it.
std::string hex_text(double value);

}  // namespace weir
