#include "daemon/config/config.h"

#include <algorithm>

namespace weir {

std::uint64_t job_memory(const ServiceConfig& service) {
  const std::uint64_t others = kDaemonMemory + std::min(service.viewer_memory, service.memory);
  if (service.memory <= others) return 0;
  return (service.memory - others) / static_cast<std::uint64_t>(service.jobs);
}

std::uint64_t standard_viewer_memory(const ServiceConfig& service, std::uint64_t least_job) {
  const std::uint64_t eighth = std::min(service.memory / 8, kMostStandardViewerMemory);
  if (eighth < kLeastViewerMemory) return 0;
  ServiceConfig with = service;
  for (const std::uint64_t bytes : {std::max(eighth, kForecastingViewerMemory), eighth}) {
    with.viewer_memory = bytes;
    if (job_memory(with) >= least_job) return bytes;
  }
  return 0;
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
