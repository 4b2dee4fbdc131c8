#include "daemon/store/file_identity.h"

#include <cerrno>

#include "format/io/file_time.h"
#include "format/io/is_directory.h"

namespace weir {

FileIdentity identity_of(const struct stat& status) {
  return {static_cast<std::uint64_t>(status.st_size), nanoseconds_of(status.st_mtim.tv_sec, status.st_mtim.tv_nsec),
          static_cast<std::uint64_t>(status.st_ino)};
}

std::optional<FileIdentity> identify(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return identity_of(status);
}

bool says_missing(int error) { return error == ENOENT || error == ENOTDIR || error == ELOOP || error == ENAMETOOLONG; }

bool is_gone(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? !S_ISREG(status.st_mode) : says_missing(errno);
}

bool is_gone_from(const std::string& directory, const std::string& path) {
  // Checks the file again: the directory may have come back after the first check.
  return is_gone(path) && is_directory(directory) && is_gone(path);
}

}  // namespace weir
