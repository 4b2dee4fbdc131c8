// Refuses work on threads in a process that was forked while its parent did such work.
#pragma once

namespace weir {

/// Held while a thread pool (oneTBB's) is limited for a piece of work. A child that is forked during that time has a
/// copy of the pool's records of threads that it does not have, and is ended by a signal if it changes them.
class ForkGuard {
 public:
  /// Throws as refuse_forked().
  ForkGuard();
  ~ForkGuard();
  ForkGuard(const ForkGuard&) = delete;
  ForkGuard& operator=(const ForkGuard&) = delete;
};

/// Throws Error(usage) in a process that was forked while a guard lived, and in its descendants. After exec a process
/// may work again.
void refuse_forked();

}  // namespace weir
