#include "daemon/jobs/process_usage.h"

#include <filesystem>
#include <iterator>
#include <system_error>

#include "format/process/process_memory.h"

namespace weir {
namespace {

std::uint64_t entries(const char* directory) {
  std::error_code error;
  const std::filesystem::directory_iterator first(directory, error);
  return error ? 0 : static_cast<std::uint64_t>(std::distance(begin(first), end(first)));
}

}  // namespace

ProcessUsage process_usage() {
  ProcessUsage usage;
  usage.resident_bytes = resident_bytes();
  const std::uint64_t descriptors = entries("/proc/self/fd");
  usage.open_descriptors = descriptors > 0 ? descriptors - 1 : 0;  // one descriptor was open only for this count
  usage.threads = entries("/proc/self/task");
  return usage;
}

}  // namespace weir
