// A stack that is used up, as by a library that follows a circle.
#pragma once

#include <sys/resource.h>

namespace weir {

/// Never returns from 1: the bound is there for compilers, which warn of a recursion without one.
inline int call_itself(unsigned depth) {
  volatile char room[4096];
  room[0] = static_cast<char>(depth);
  return depth == 0 ? 0 : call_itself(depth + 1) + room[0];
}

/// Never returns. The main thread's stack ends at 8 MiB, where it has no end.
inline int use_up_stack() {
  rlimit stack{};
  ::getrlimit(RLIMIT_STACK, &stack);
  if (stack.rlim_cur == RLIM_INFINITY) {
    stack.rlim_cur = rlim_t{8} << 20U;
    ::setrlimit(RLIMIT_STACK, &stack);
  }
  return call_itself(1);
}

}  // namespace weir
