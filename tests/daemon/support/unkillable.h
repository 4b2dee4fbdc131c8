// Processes that this one may not kill, for tests of what it does with a process that does not end: one that waits for
// a device or a file server that hangs ends by no signal either. Root only.
#pragma once

#include <unistd.h>

#include <stdexcept>

namespace weir {

/// While it lives, signals of this process reach none that was started before.
class Unkillable {
 public:
  static bool possible() { return ::geteuid() == 0; }
  Unkillable() {
    if (::setresuid(kNobody, kNobody, 0) != 0) throw std::runtime_error("setresuid failed");
  }
  ~Unkillable() {
    if (::setresuid(0, 0, 0) != 0) ::_exit(1);  // the tests behind it would run as another user
  }
  Unkillable(const Unkillable&) = delete;
  Unkillable& operator=(const Unkillable&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
};

}  // namespace weir
