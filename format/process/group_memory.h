// What the limits of control groups leave a process: of a container, a batch job, a service.
#pragma once

#include <cstdint>
#include <string>

namespace weir {

/// Bytes up to the nearest limit of the groups that this process is in, cgroup v2 or v1; caches of
/// files on disks, which the system may drop, are not counted as taken. The largest number where there is no limit.
/// `groups` lists the groups as /proc/self/cgroup does, which lie below `mounts`; a level that cannot be read has no
/// limit.
std::uint64_t group_room(const std::string& groups = "/proc/self/cgroup", const std::string& mounts = "/sys/fs/cgroup");

}  // namespace weir
