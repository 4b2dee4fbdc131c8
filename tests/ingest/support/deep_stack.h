// Overflows the stack, as a library does that follows a circular reference.
#pragma once

#include <sys/resource.h>

namespace weir {

/// Never returns when called with 1. The bound exists because compilers warn of a recursion without a bound.
inline int call_itself(unsigned depth) {
  volatile char room[4096];
  room[0] = static_cast<char>(depth);
  return depth == 0 ? 0 : call_itself(depth + 1) + room[0];
}

/// Never returns. An unlimited main stack is first limited to 8 MiB.
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
