#include "format/error.h"

#include <cerrno>
#include <system_error>

namespace weir {

Error io_error(const std::string& path, const std::string& action, int errno_value) {
  std::string remedy;
  if (errno_value == ENOSPC || errno_value == EDQUOT) {
    remedy = "; free space on that file system or choose another with -o or --work-dir";
  } else if (errno_value == EACCES || errno_value == EPERM || errno_value == EROFS) {
    remedy = "; check the permissions or choose another place";
  }
  return Error(ErrorKind::io,
               path + ": cannot " + action + ": " + std::generic_category().message(errno_value) + remedy);
}

}  // namespace weir
