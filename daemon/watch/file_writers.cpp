#include "daemon/watch/file_writers.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

#include "daemon/watch/file_system_kind.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

bool sees_all_changes(int file) {
  const int kept = errno;
  struct statfs status {};
  const bool local = ::fstatfs(file, &status) == 0 && file_system_kind(status).sees_all_changes;
  errno = kept;
  return local;
}

// Returns false in a container, because its /proc shows only its own processes.
bool sees_all_processes() {
  constexpr ino_t kNamespaceOfTheSystem = 0xEFFFFFFC;  // PROC_PID_INIT_INO of Linux
  struct stat own {};
  return ::stat("/proc/self/ns/pid", &own) == 0 && own.st_ino == kNamespaceOfTheSystem;
}

bool is_process(const fs::path& directory) {
  return directory.filename().string().find_first_not_of("0123456789") == std::string::npos;
}

// Returns whether /proc/PID/fdinfo/FD allows writing. The line is "flags:\t0100002", in octal.
bool may_write(const fs::path& information) {
  std::ifstream lines(information);
  std::string word;
  while (lines >> word) {
    if (word != "flags:") continue;
    int flags = 0;
    lines >> std::oct >> flags;
    return (flags & O_ACCMODE) != O_RDONLY;
  }
  return false;
}

// Sets `error` if the descriptors of the process cannot be listed.
bool has_descriptor(const fs::path& process, const struct stat& file, std::error_code& error) {
  for (fs::directory_iterator at(process / "fd", error), end; !error && at != end; at.increment(error)) {
    struct stat status {};
    if (::stat(at->path().c_str(), &status) != 0) continue;
    if (status.st_dev == file.st_dev && status.st_ino == file.st_ino &&
        may_write(process / "fdinfo" / at->path().filename())) {
      return true;
    }
  }
  return false;
}

// Lines of /proc/PID/maps are "7f00-7f10 rw-s 00000000 fe:00 1234 PATH"; device and inode are the fourth and fifth
// field.
bool has_mapping(const fs::path& process, const struct stat& file) {
  std::ifstream maps(process / "maps");
  std::string line;
  while (std::getline(maps, line)) {
    std::istringstream words(line);
    std::string range;
    std::string rights;
    std::string offset;
    unsigned major = 0;
    unsigned minor = 0;
    char colon = 0;
    ino_t inode = 0;
    words >> range >> rights >> offset >> std::hex >> major >> colon >> minor >> std::dec >> inode;
    if (!words || rights.size() != 4 || rights[1] != 'w' || rights[3] != 's') continue;
    if (inode == file.st_ino && makedev(major, minor) == file.st_dev) return true;
  }
  return false;
}

}  // namespace

FileWriters::FileWriters(const std::string& path) : file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  // The kernel sends SIGIO to the holder of a lease when a writer waits. The signal is ignored, because the lease
  // ends with the object anyway.
  static const auto ignored = std::signal(SIGIO, SIG_IGN);
  static_cast<void>(ignored);
  struct stat status {};
  if (!file_ || ::fstat(file_.get(), &status) != 0) {
    some_ = true;  // most likely, the open fails because a file server holds a lease for writing
    return;
  }
  if (::fcntl(file_.get(), F_SETLEASE, F_RDLCK) == 0) {
    leased_ = true;
    return;
  }
  // On a file server's file, the kernel refuses the lease without a lease of the server, whether or not a program
  // writes. So EAGAIN means a writer only on a local file system.
  const bool local = sees_all_changes(file_.get());
  if (errno == EAGAIN && local) {
    some_ = true;
    return;
  }
  known_ = local && ::geteuid() == 0 && sees_all_processes();
  std::error_code error;
  for (fs::directory_iterator at("/proc", error), end; !error && at != end && !some_; at.increment(error)) {
    if (!is_process(at->path())) continue;
    std::error_code unlisted;
    some_ = has_descriptor(at->path(), status, unlisted) || has_mapping(at->path(), status);
    const bool ended = unlisted == std::errc::no_such_file_or_directory || unlisted == std::errc::no_such_process;
    if (unlisted && !ended) known_ = false;
  }
}

// While a lease is being broken, F_GETLEASE returns the type that it is to become.
bool FileWriters::one_waits() const { return leased_ && ::fcntl(file_.get(), F_GETLEASE) != F_RDLCK; }

FileWriters::~FileWriters() {
  if (leased_) ::fcntl(file_.get(), F_SETLEASE, F_UNLCK);
}

}  // namespace weir
