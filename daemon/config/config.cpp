#include "daemon/config/config.h"

#include <algorithm>

namespace weir {

std::uint64_t job_memory(const ServiceConfig& service) {
  if (service.memory <= kDaemonMemory) return 0;
  return (service.memory - kDaemonMemory) / static_cast<std::uint64_t>(service.jobs);
}

std::optional<std::string> WatchConfig::convert_option(std::string_view option) const {
  for (const std::string& argument : convert_options) {
    const std::size_t end = std::min(argument.find('='), argument.size());
    if (argument.substr(2, end - 2) != option) continue;
    return end == argument.size() ? "true" : argument.substr(end + 1);
  }
  return std::nullopt;
}

}  // namespace weir
