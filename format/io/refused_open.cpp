#include "format/io/refused_open.h"

#include <cerrno>
#include <system_error>

#include "format/base/text.h"

namespace weir {

bool is_fault_of_name(int errno_value) {
  return errno_value == ENOENT || errno_value == ENOTDIR || errno_value == EISDIR || errno_value == ELOOP ||
         errno_value == ENAMETOOLONG || errno_value == EINVAL;
}

Error refused_open(const std::string& path, const char* action, int errno_value) {
  const char* remedy = errno_value == EACCES || errno_value == EPERM
                           ? "; give this user the right to read it and to enter its directories"
                           : remedy_of(errno_value);
  return {is_fault_of_name(errno_value) ? ErrorKind::input : ErrorKind::io,
          cat(path, ": cannot ", action, ": ", std::generic_category().message(errno_value), remedy),
          SystemFailure{errno_value, path}};
}

}  // namespace weir
