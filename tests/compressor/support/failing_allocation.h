// Memory that runs out, for tests of what is left behind then.
#pragma once

namespace weir {

/// While it is there, the calling thread's allocation that comes after `before` others throws std::bad_alloc.
class FailingAllocation {
 public:
  explicit FailingAllocation(int before);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;
};

}  // namespace weir
