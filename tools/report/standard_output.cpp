#include "tools/report/standard_output.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string_view>
#include <system_error>

namespace weir {
namespace {

// Returns an errno for an earlier failed write, whose own errno is lost: the errno of one more write.
int later_reason() { return ::write(STDOUT_FILENO, "\n", 1) < 0 ? errno : EIO; }

}  // namespace

Error stdout_error(int errno_value) {
  const bool full = errno_value == ENOSPC || errno_value == EDQUOT || errno_value == EFBIG;
  const std::string_view remedy = full                   ? "; free space there or redirect it to another file"
                                  : errno_value == EPIPE ? ""
                                                         : "; redirect it to a file or a program";
  return {ErrorKind::io, compose("stdout: cannot write: ", std::generic_category().message(errno_value), remedy),
          SystemFailure{errno_value, "stdout"}};
}

void finish_stdout() {
  const bool failed_before = std::ferror(stdout) != 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && !failed_before) return;
  const int reason = flushed ? later_reason() : errno;
  if (reason == EPIPE) return;
  throw stdout_error(reason);
}

}  // namespace weir
