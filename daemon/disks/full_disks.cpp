#include "daemon/disks/full_disks.h"

#include <algorithm>

#include "format/base/text.h"

namespace weir {

void FullDisks::add(std::uint64_t device, const std::string& directory, std::uint64_t free, std::int64_t job,
                    std::uint64_t source_bytes, std::uint64_t needed, Time now) {
  const double need = source_bytes == 0 ? 0 : static_cast<double>(needed) / static_cast<double>(source_bytes);
  Full& full = full_.try_emplace(device, Full{directory, free, need, needed, {}, now}).first->second;
  full.free = std::min(full.free, free);
  full.need = std::min(full.need, need);
  full.refused = std::min(full.refused, needed);
  full.jobs.insert(job);
}

bool FullDisks::admits(std::uint64_t device, std::int64_t job, std::uint64_t source_bytes) const {
  const auto at = full_.find(device);
  if (at == full_.end()) return true;
  const Full& full = at->second;
  if (full.jobs.contains(job) || full.refused == 0 || full.need == 0) return false;
  const double estimate = full.need * static_cast<double>(source_bytes);
  return estimate < static_cast<double>(full.refused) && estimate <= static_cast<double>(full.free);
}

std::string FullDisks::directory_on(std::uint64_t device) const {
  const auto at = full_.find(device);
  return at == full_.end() ? "" : at->second.directory;
}

std::string FullDisks::hold_of(const DiskRoom& disk) const {
  const std::string directory = directory_on(disk.device);
  if (directory.empty()) return "";
  return cat("no room in ", directory, ", where ", format_bytes(disk.free), " are free; what needs more waits for it");
}

std::vector<std::string> FullDisks::directories() const {
  std::vector<std::string> names;
  for (const auto& [device, full] : full_) names.push_back(full.directory);
  return names;
}

std::vector<std::string> FullDisks::look(const std::function<std::uint64_t(const std::string& directory)>& free_of,
                                         Time now) {
  std::vector<std::string> ended;
  for (auto at = full_.begin(); at != full_.end();) {
    const Full& full = at->second;
    const std::uint64_t free = free_of(full.directory);
    if (free < full.free + kMoreRoom && now - full.since < kRetry) {
      ++at;
      continue;
    }
    ended.push_back(full.directory);
    at = full_.erase(at);
  }
  return ended;
}

}  // namespace weir
