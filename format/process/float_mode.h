// Sets the floating-point mode that weir computes in, whatever mode the caller has set.
#pragma once

#include <cfenv>

namespace weir {

/// While it lives, the calling thread rounds to nearest, keeps subnormal numbers and traps nothing. Files, certificates
/// and FORMAT.md rely on this mode. The destructor restores the caller's mode: -ffast-math, for instance, sets a mode
/// for a whole program that makes subnormal numbers 0. Threads started while it lives begin with its mode.
class FloatMode {
 public:
  FloatMode() {
    std::fegetenv(&callers_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~FloatMode() { std::fesetenv(&callers_); }
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;

 private:
  std::fenv_t callers_;
};

}  // namespace weir
