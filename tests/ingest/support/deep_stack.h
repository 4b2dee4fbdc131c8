// A stack that is used up, as by a library that follows a circle.
#pragma once

namespace weir {

/// Never returns from 1: the bound is there for compilers, which warn of a recursion without one.
inline int use_up_stack(unsigned depth) {
  volatile char room[4096];
  room[0] = static_cast<char>(depth);
  return depth == 0 ? 0 : use_up_stack(depth + 1) + room[0];
}

}  // namespace weir
