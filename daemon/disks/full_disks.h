// File systems on which a job found no room, and the jobs that wait for them. Jobs for other file systems go on, and
// so do jobs with small enough outputs. Pure: the caller passes the time and the free space.
//
// The size of an output is known only after its source was read. Before, it is estimated from the output of the job
// that found no room, in proportion to the sizes of the sources.
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

  /// A file system is tried again when it has kMoreRoom more free bytes, or after kRetry at the latest (a quota shows
  /// in no figure).
  static constexpr std::uint64_t kMoreRoom = std::uint64_t{1} << 20;
  static constexpr std::chrono::seconds kRetry{60};

  /// Records that `job`, with a source of `source_bytes`, found no room in `directory` on the file system `device`,
  /// which had `free` bytes left. The output needed `needed` bytes; 0: not known, and then all other jobs wait.
  void add(std::uint64_t device, const std::string& directory, std::uint64_t free, std::int64_t job,
           std::uint64_t source_bytes, std::uint64_t needed, Time now);
  /// Returns whether the job, whose source has `source_bytes`, may write to `device` now. A job that found no room
  /// there waits in any case.
  bool admits(std::uint64_t device, std::int64_t job, std::uint64_t source_bytes) const;
  bool empty() const { return full_.empty(); }
  /// Returns the directory in which output found no room on `device`; empty if there is room.
  std::string directory_on(std::uint64_t device) const;
  /// Returns in words why jobs with outputs on `disk` wait; empty if they do not.
  std::string hold_of(const DiskRoom& disk) const;
  /// Returns one directory of each full file system.
  std::vector<std::string> directories() const;
  /// Forgets the file systems that are to be tried again, and returns their directories. `free_of` returns the
  /// present free space.
  std::vector<std::string> look(const std::function<std::uint64_t(const std::string& directory)>& free_of, Time now);

 private:
  struct Full {
    std::string directory;
    std::uint64_t free = 0;
    double need = 0;              ///< bytes of output per byte of source; the least that was refused
    std::uint64_t refused = 0;    ///< bytes of the smallest output that found no room; 0: not known
    std::set<std::int64_t> jobs;  ///< jobs that were refused
    Time since;                   ///< when the first job was refused
  };
  std::map<std::uint64_t, Full> full_;  ///< by device
};

}  // namespace weir
