#include "daemon/config/check_access.h"

#include <fcntl.h>
#include <linux/magic.h>
#include <pwd.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

#include "daemon/config/foreign_state.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "format/io/is_directory.h"
#include "format/io/mount_table.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

std::string user_name() {
  std::array<char, 1024> room{};
  passwd entry{};
  passwd* found = nullptr;
  const uid_t id = ::geteuid();
  if (::getpwuid_r(id, &entry, room.data(), room.size(), &found) == 0 && found != nullptr) return found->pw_name;
  return cat("with the ID ", id);
}

std::string remedy(int error, std::string_view key, const std::string& path) {
  const std::string other = cat("or choose another ", key);
  if (error == EROFS) {
    return cat("mount it for writing, in a unit of systemd add ReadWritePaths=", path, " (systemctl edit), ", other);
  }
  if (error == ENOTDIR || error == EISDIR) return cat("choose another ", key);
  if (error == ENOENT) return cat("make it, ", other);
  if (error == EACCES) return cat("give that user the permission (chown, chmod, setfacl), ", other);
  return cat("check the file system, ", other);
}

[[noreturn]] void refuse_access(const std::string& path, std::string_view key, const char* what, int error) {
  throw Error(ErrorKind::io, cat(path, ": ", key, " cannot be ", what, " by user ", user_name(), ": ",
                                 std::strerror(error), "; ", remedy(error, key, path)));
}

bool may(const std::string& path, int mode) { return ::faccessat(AT_FDCWD, path.c_str(), mode, AT_EACCESS) == 0; }

/// Returns whether `path` exists and is something else than a directory.
bool is_no_directory(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && !is_directory(path);
}

/// Returns whether `directory` is on a file system in which only the kernel makes files. To root it looks writable.
bool is_of_the_kernel(const std::string& directory) {
  constexpr std::array<std::uint32_t, 4> kTypes{PROC_SUPER_MAGIC, SYSFS_MAGIC, CGROUP_SUPER_MAGIC, CGROUP2_SUPER_MAGIC};
  struct statfs status {};
  return ::statfs(directory.c_str(), &status) == 0 &&
         std::ranges::find(kTypes, static_cast<std::uint32_t>(status.f_type)) != kTypes.end();
}

void require_writable_directory(const std::string& path, std::string_view key) {
  if (is_no_directory(path)) refuse_access(path, key, "written to", ENOTDIR);
  if (!may(path, W_OK | X_OK)) refuse_access(path, key, "written to", errno);
}

/// Requires a writable file. It may be missing if its directory exists and is writable.
void require_file(const std::string& path, std::string_view key) {
  if (path.empty()) return;
  require_writable_directory(fs::path(path).parent_path().string(), key);
  if (is_directory(path)) refuse_access(path, key, "written to", EISDIR);
  if (!may(path, R_OK | W_OK) && errno != ENOENT) refuse_access(path, key, "written to", errno);
}

/// Requires of the work directory what each conversion requires of it.
void require_work_dir(const std::string& path) {
  if (path.empty()) return;
  require_writable_directory(path, "work_dir");
  if (make_posix_file_system()->is_memory(path)) {
    throw Error(ErrorKind::io, cat(path, ": work_dir lies on a memory file system; choose a directory on a disk"));
  }
}

/// Requires a writable directory. It and its parents may be missing if they can be made.
void require_directory(const std::string& path, std::string_view key) {
  if (path.empty()) return;
  fs::path there = path;
  std::error_code ignored;
  while (!fs::exists(there, ignored) && !ignored && there.has_relative_path()) there = there.parent_path();
  if (is_of_the_kernel(there.string())) {
    throw Error(ErrorKind::io,
                cat(path, ": ", key, " lies on a file system of the kernel; choose a directory on a disk"));
  }
  require_writable_directory(there.string(), key);
}

}  // namespace

void check_access(const DaemonConfig& config, bool state_is_open) {
  const ServiceConfig& service = config.service;
  require_file(service.state, "state");
  if (!state_is_open) refuse_foreign_state(service.state);
  require_file(service.log_file, "log");
  require_file(service.port_file, "port_file");
  require_file(service.control_socket, "control_socket");
  require_work_dir(service.work_dir);
  for (const WatchConfig& watch : config.watches) {
    if (is_mounted(watch.output_mount)) require_directory(watch.output, "output");
    std::error_code ignored;
    if (!fs::exists(watch.directory, ignored) && !ignored) continue;
    if (is_no_directory(watch.directory)) refuse_access(watch.directory, "directory", "read", ENOTDIR);
    if (!may(watch.directory, R_OK | X_OK)) refuse_access(watch.directory, "directory", "read", errno);
    if (watch.source == AfterDone::delete_after_verify) require_writable_directory(watch.directory, "directory");
  }
}

}  // namespace weir
