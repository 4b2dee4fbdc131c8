#include "daemon/output_disks.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>

#include "format/real_path.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kWindow{600};
constexpr double kYear_s = 365.0 * 24 * 3600;

// The highest directory above `directory` that is on the same file system.
std::string mount_of(const std::string& directory, std::uint64_t device) {
  fs::path at = real_path(directory);
  std::string mount = at.string();
  for (;; at = at.parent_path()) {
    struct stat status {};
    if (::stat(at.c_str(), &status) == 0) {
      if (static_cast<std::uint64_t>(status.st_dev) != device) return mount;
      mount = at.string();
    }
    if (at == at.parent_path()) return mount;
  }
}

}  // namespace

void OutputDisks::written(const std::string& directory, std::uint64_t bytes, Time now) {
  rates_.try_emplace(room_in(directory).device, kWindow, start_).first->second.add(bytes, now);
}

std::vector<OutputDisk> OutputDisks::look(std::span<const std::string> directories, Time now) const {
  std::vector<OutputDisk> disks;
  for (const std::string& directory : directories) {
    const DiskRoom room = room_in(directory);
    const auto known = std::find_if(disks.begin(), disks.end(),
                                    [&](const OutputDisk& disk) { return disk.room.device == room.device; });
    if (known != disks.end()) {
      if (std::find(known->directories.begin(), known->directories.end(), directory) == known->directories.end()) {
        known->directories.push_back(directory);
      }
      continue;
    }
    OutputDisk& disk = disks.emplace_back(OutputDisk{mount_of(directory, room.device), {directory}, room, 0, {}});
    if (const auto rate = rates_.find(room.device); rate != rates_.end()) {
      disk.written_bytes_per_s = rate->second.at(now).bytes_per_s;
    }
    const double fills_in_s = static_cast<double>(room.free) / disk.written_bytes_per_s;
    if (fills_in_s < kYear_s) disk.fills_in_s = fills_in_s;
  }
  return disks;
}

}  // namespace weir
