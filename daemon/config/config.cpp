#include "daemon/config/config.h"

#include <algorithm>

namespace weir {

std::uint64_t job_memory(const ServiceConfig& service) {
  const std::uint64_t others = kDaemonMemory + std::min(service.viewer_memory, service.memory);
  if (service.memory <= others) return 0;
  return (service.memory - others) / static_cast<std::uint64_t>(service.jobs);
}

std::uint64_t standard_viewer_memory(const ServiceConfig& service, std::uint64_t least_job) {
  ServiceConfig with = service;
  with.viewer_memory = std::min(service.memory / 8, kMostStandardViewerMemory);
  const bool fits = with.viewer_memory >= kLeastViewerMemory && job_memory(with) >= least_job;
  return fits ? with.viewer_memory : 0;
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
