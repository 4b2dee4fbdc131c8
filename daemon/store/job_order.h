// The order in which jobs are listed.
#pragma once

#include <array>
#include <string_view>

namespace weir {

enum class JobOrderKey { changed, discovered, source, state, watch, bytes, seconds };

/// Names in the API, indexed by JobOrderKey.
inline constexpr std::array<std::string_view, 7> kJobOrderKeys{"changed", "discovered", "source", "state",
                                                               "watch",   "bytes",      "seconds"};

struct JobOrder {
  JobOrderKey key = JobOrderKey::changed;
  bool descending = true;
};

}  // namespace weir
