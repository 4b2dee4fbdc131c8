// The file systems that outputs are written to: how full they are, and how fast they fill. A separate thread looks at
// them every few seconds, because a call to a hanging file server does not return.
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
  std::vector<std::string> directories;  ///< output directories on it
  DiskRoom room;                         ///< as of the last look
  double written_bytes_per_s = 0;        ///< bytes of outputs, over the last ten minutes
  std::optional<double> fills_in_s;      ///< at this rate; none: not within a year
  std::chrono::seconds silent{0};        ///< for how long it has not answered; 0 if a look takes no longer than usual
};

class OutputDisks {
 public:
  using Time = RecentRate::Time;

  using RoomIn = std::function<DiskRoom(const std::string& directory)>;

  /// `room_in` is for tests. It is called on the thread, and may never return.
  explicit OutputDisks(RoomIn room_in = weir::room_in);
  /// Does not wait for a look that hangs.
  ~OutputDisks();
  OutputDisks(const OutputDisks&) = delete;
  OutputDisks& operator=(const OutputDisks&) = delete;

  /// Looks at the file systems of `directories` at once and from now on.
  void watch(const std::vector<std::string>& directories);
  /// Records that an output of `bytes` was written into `directory`, which is a watched directory or lies below one.
  void written(const std::string& directory, std::uint64_t bytes, Time now);
  /// Returns the room on the file system of `directory` at the last look. The look began after the first call for
  /// `directory`, or after the last look_anew(); none before such a look. Looks go on as long as the function is
  /// called at least once a minute. Never waits.
  std::optional<DiskRoom> room(const std::string& directory) const;
  /// Discards what room() knows of `directory`, for example because a job found it full.
  void look_anew(const std::string& directory);
  /// Returns each file system once, in the order of its first directory. File systems that were never looked at are
  /// left out. Never waits.
  std::vector<OutputDisk> disks(Time now) const;

 private:
  struct Looker;
  Time start_ = std::chrono::steady_clock::now();
  std::map<std::uint64_t, RecentRate> rates_;  ///< by device
  std::shared_ptr<Looker> looker_;
};

}  // namespace weir
