// File systems on which a job found no room, and which jobs wait for it: those for other file systems go on, and so do
// those whose outputs are small enough. Pure: it is told the time and the room.
//
// What an output takes is known once its source has been read. Before, it is estimated from that of the job that found
// no room, in proportion to the sizes of their sources.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "daemon/disks/disk_room.h"

namespace weir {

class FullDisks {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Tried again when so much more room is there, or after so long at the latest (a quota shows in no figure).
  static constexpr std::uint64_t kMoreRoom = std::uint64_t{1} << 20;
  static constexpr std::chrono::seconds kRetry{60};

  /// Where `free` bytes were left on the file system `device`, in `directory`, the source of `job`, of `source_bytes`,
  /// found no room for the `needed` bytes of its output (0: not known, then all others wait).
  void add(std::uint64_t device, const std::string& directory, std::uint64_t free, std::int64_t job,
           std::uint64_t source_bytes, std::uint64_t needed, Time now);
  /// Whether that job, whose source has that size, may write to `device` now. One that found no room waits in any case.
  bool admits(std::uint64_t device, std::int64_t job, std::uint64_t source_bytes) const;
  bool empty() const { return full_.empty(); }
  /// Where output found no room on `device`; empty: there is room.
  std::string directory_on(std::uint64_t device) const;
  /// Why jobs with outputs on `disk` wait, in words; empty: they do not.
  std::string hold_of(const DiskRoom& disk) const;
  /// A directory of each.
  std::vector<std::string> directories() const;
  /// Forgets those that are to be tried again; `free_of` tells the room there now. Returns their directories.
  std::vector<std::string> look(const std::function<std::uint64_t(const std::string& directory)>& free_of, Time now);

 private:
  struct Full {
    std::string directory;
    std::uint64_t free = 0;
    double need = 0;              ///< bytes of output for a byte of source; the least that was refused
    std::uint64_t refused = 0;    ///< bytes of the smallest output that found no room; 0: not known
    std::set<std::int64_t> jobs;  ///< that were refused
    Time since;                   ///< of the first
  };
  std::map<std::uint64_t, Full> full_;  ///< by device
};

}  // namespace weir
