// Makes memory run out, for tests of what code leaves behind when that happens.
#pragma once

namespace weir {

/// While an object lives, one allocation of the calling thread throws std::bad_alloc: the one after `before` others.
class FailingAllocation {
 public:
  explicit FailingAllocation(int before);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;
};

}  // namespace weir
