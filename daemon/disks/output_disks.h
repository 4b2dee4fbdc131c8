// The file systems that outputs are written to: how full they are, and how fast
// they fill. A thread of its own looks at them every few seconds, since a call to a file server that hangs does not
// return.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/disks/disk_room.h"
#include "daemon/disks/recent_rate.h"

namespace weir {

struct OutputDisk {
  std::string path;                      ///< where it is mounted
  std::vector<std::string> directories;  ///< outputs' that lie on it
  DiskRoom room;                         ///< as of the last look
  double written_bytes_per_s = 0;        ///< of outputs, over the last ten minutes
  std::optional<double> fills_in_s;      ///< at that rate; none: not within a year
  std::chrono::seconds silent{0};        ///< for how long it has not answered, where that is longer than it should take
};

class OutputDisks {
 public:
  using Time = RecentRate::Time;

  using RoomIn = std::function<DiskRoom(const std::string& directory)>;

  /// `room_in`: for tests; it is called on the thread, and may not return.
  explicit OutputDisks(RoomIn room_in = weir::room_in);
  /// Does not wait for a look that hangs.
  ~OutputDisks();
  OutputDisks(const OutputDisks&) = delete;
  OutputDisks& operator=(const OutputDisks&) = delete;

  /// Looks at the file systems of these from now on, and at once.
  void watch(const std::vector<std::string>& directories);
  /// An output of `bytes` was written into `directory`, which is one of those or lies below one.
  void written(const std::string& directory, std::uint64_t bytes, Time now);
  /// Of the file system that `directory` lies on, as of the last look at it, one that was begun after the first call or
  /// the last look_anew(); none before. It is looked at as long as this is called now and then. Never waits.
  std::optional<DiskRoom> room(const std::string& directory) const;
  /// What room() knows of `directory` is of the past, as where a job found it full.
  void look_anew(const std::string& directory);
  /// Each once, in the order of the first directory of each; those that were never looked at are left out. Never waits.
  std::vector<OutputDisk> disks(Time now) const;

 private:
  struct Looker;
  Time start_ = std::chrono::steady_clock::now();
  std::map<std::uint64_t, RecentRate> rates_;  ///< by device
  std::shared_ptr<Looker> looker_;
};

}  // namespace weir
