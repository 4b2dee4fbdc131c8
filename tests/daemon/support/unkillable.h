// Makes processes that the test may not kill, to test the handling of a process that does not end: a process that
// waits for a hanging device or file server ignores all signals, too. Root only.
#pragma once

#include <unistd.h>

#include <stdexcept>

namespace weir {

/// While the object lives, no signal of this process reaches a process that was started before.
class Unkillable {
 public:
  static bool possible() { return ::geteuid() == 0; }
  Unkillable() {
    if (::setresuid(kNobody, kNobody, 0) != 0) throw std::runtime_error("setresuid failed");
  }
  ~Unkillable() {
    if (::setresuid(0, 0, 0) != 0) ::_exit(1);  // otherwise the following tests would run as another user
  }
  Unkillable(const Unkillable&) = delete;
  Unkillable& operator=(const Unkillable&) = delete;

 private:
  static constexpr uid_t kNobody = 65534;
};

}  // namespace weir
