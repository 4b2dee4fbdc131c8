// Numbers as text that loses nothing.
#pragma once

#include <string>

namespace weir {

/// The shortest text that reads back as the same double.
std::string exact_text(double value);

/// In hexadecimal, "0x1.8p+1", as std::hexfloat writes it.
std::string hex_text(double value);

}  // namespace weir
