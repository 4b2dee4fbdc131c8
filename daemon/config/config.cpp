#include "daemon/config/config.h"

#include <algorithm>

#include "format/base/text.h"

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

std::string no_viewer_reason(const ServiceConfig& service) {
  if (!service.is_standard_viewer) return "viewer_memory is 0 in the configuration";
  constexpr std::uint64_t kLeastMemoryWithViewer = 8 * kLeastViewerMemory;
  if (service.memory < kLeastMemoryWithViewer) {
    return cat("memory is ", format_bytes(service.memory), ", and below ", format_bytes(kLeastMemoryWithViewer),
               " there is none by default; set viewer_memory = \"", kLeastViewerMemory >> 20U,
               "MiB\" or give more memory");
  }
  return cat("memory is ", format_bytes(service.memory), ", and with a viewer each of ", service.jobs,
             " jobs would get too little of it; give more memory, or fewer jobs");
}

bool WatchConfig::takes_any_raw() const { return convert_option("dims") || convert_option("type"); }

std::string WatchConfig::unused_key() const {
  if (!gives_delete_after || source == AfterDone::delete_after_verify) return "";
  return "delete_after has no effect, since nothing is deleted; set source = \"delete-after-verify\", or leave it out";
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
