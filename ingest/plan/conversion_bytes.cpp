#include "ingest/plan/conversion_bytes.h"

#include <algorithm>

#include "format/base/text.h"

namespace weir {

std::string memory_beside_conversion(std::uint64_t bytes) {
  return cat((std::max(2 * bytes, bytes + kConversionBytes) >> 20U) + 1, "MiB");
}

}  // namespace weir
