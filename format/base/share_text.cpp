#include "format/base/share_text.h"

#include <cmath>

#include "format/base/text.h"

namespace weir {

std::string share_text(std::uint64_t part, std::uint64_t whole) {
  const double tenths = std::round(1000 * (static_cast<double>(part) / static_cast<double>(whole)));
  if (tenths < 1 && part > 0) return "less than 0.1 %";
  if (tenths > 999 && part < whole) return "more than 99.9 %";
  return cat(tenths / 10, " %");
}

}  // namespace weir
