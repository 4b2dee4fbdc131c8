// Numbers as text that loses nothing.
#pragma once

#include <string>

namespace weir {

/// The shortest text that reads back as the same double.
std::string exact_text(double value);

}  // namespace weir
