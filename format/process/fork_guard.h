// Refuses work on threads in a process that was forked while its parent did such work.
#pragma once

namespace weir {

/// Held while a thread pool (oneTBB's) is limited for a piece of work. A child that is forked meanwhile has a copy of
/// the pool's records of threads that it does not have, and ends by a signal where it changes them.
class ForkGuard {
 public:
  /// Throws what refuse_forked does.
  ForkGuard();
  ~ForkGuard();
  ForkGuard(const ForkGuard&) = delete;
  ForkGuard& operator=(const ForkGuard&) = delete;
};

/// Throws Error(usage) in a process that was forked while a guard lived, or comes from one that was. exec makes a
/// process that may work again.
void refuse_forked();

}  // namespace weir
