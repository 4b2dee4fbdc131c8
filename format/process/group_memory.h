// The memory that the limits of control groups (of a container, a batch job, a service) leave a process.
#pragma once

#include <cstdint>
#include <string>

namespace weir {

/// Returns the bytes up to the nearest limit of the groups that this process is in, cgroup v2 or v1; the largest number
/// if there is no limit. Caches of files on disks, which the system may drop, do not count as taken. `groups` lists the
/// groups in the format of /proc/self/cgroup; they lie below `mounts`. A level that cannot be read has no limit.
std::uint64_t group_room(const std::string& groups = "/proc/self/cgroup", const std::string& mounts = "/sys/fs/cgroup");

}  // namespace weir
