#include "format/base/error.h"

#include <cerrno>
#include <system_error>

namespace weir {

Error usage_error(const std::string& message) { return {ErrorKind::usage, message}; }

Error input_error(const std::string& path, const std::string& message) {
  return {ErrorKind::input, path + ": " + message};
}

Error io_error(const std::string& path, const std::string& action, int errno_value) {
  std::string remedy;
  if (errno_value == ENOSPC || errno_value == EDQUOT) {
    remedy = kDiskFullRemedy;
  } else if (errno_value == EACCES || errno_value == EPERM || errno_value == EROFS) {
    remedy = "; check the permissions or choose another place";
  } else if (errno_value == EFBIG) {
    remedy = "; raise the limit of file size (ulimit -f) or choose another file system";
  }
  return Error(ErrorKind::io,
               path + ": cannot " + action + ": " + std::generic_category().message(errno_value) + remedy);
}

}  // namespace weir
