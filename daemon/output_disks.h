// The file systems that outputs are written to: how full they are, and how fast
// they fill.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/disk_room.h"
#include "daemon/recent_rate.h"

namespace weir {

struct OutputDisk {
  std::string path;                      ///< where it is mounted
  std::vector<std::string> directories;  ///< outputs' that lie on it
  DiskRoom room;
  double written_bytes_per_s = 0;    ///< of outputs, over the last ten minutes
  std::optional<double> fills_in_s;  ///< at that rate; none: not within a year
};

class OutputDisks {
 public:
  using Time = RecentRate::Time;

  /// An output of `bytes` was written into `directory`.
  void written(const std::string& directory, std::uint64_t bytes, Time now);
  /// The file systems of `directories`, each once, in the order of the first of each.
  std::vector<OutputDisk> look(std::span<const std::string> directories, Time now) const;

 private:
  Time start_ = std::chrono::steady_clock::now();
  std::map<std::uint64_t, RecentRate> rates_;  ///< by device
};

}  // namespace weir
