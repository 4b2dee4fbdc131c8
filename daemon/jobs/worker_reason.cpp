#include "daemon/jobs/worker_reason.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

std::string worker_reason(std::string_view step, const WorkerEnd& end) {
  constexpr std::string_view kBegin = "weir: ";
  if (end.exit_code > kSignalExit && end.exit_code != static_cast<int>(ErrorKind::interrupted)) {
    const int signal = end.exit_code - kSignalExit;
    return cat(step, " was ended by signal ", signal, " (", ::strsignal(signal), ')',
               signal == SIGKILL ? "; the system may have been out of memory" : "");
  }
  std::string reason;
  for (const std::string& line : split(end.log, '\n')) {
    if (line.starts_with(kBegin)) reason = line.substr(kBegin.size());
  }
  return reason.empty() ? cat(step, " ended with exit code ", end.exit_code, " and no message") : reason;
}

bool is_disk_full(int errno_value) { return errno_value == ENOSPC || errno_value == EDQUOT; }

bool says_disk_full(std::string_view reason) {
  const auto says = [&](int errno_value) {
    return reason.find(": " + std::generic_category().message(errno_value)) != std::string_view::npos;
  };
  return says(ENOSPC) || says(EDQUOT);
}

}  // namespace weir
