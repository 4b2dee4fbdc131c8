// The floating-point mode that weir computes in, whatever a caller has set.
#pragma once

#include <cfenv>

namespace weir {

/// While it lives, the calling thread rounds to nearest, takes subnormal numbers for what they are and traps nothing:
/// what files, certificates and FORMAT.md count on. Then the caller's mode is back: -ffast-math, for instance, sets one
/// for a whole program in which subnormal numbers are 0. Threads that are started meanwhile begin with its mode.
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
