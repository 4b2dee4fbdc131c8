// Work that goes on beside the caller's.
#pragma once

#include <future>
#include <system_error>

namespace weir {

/// Begins `work`, whose result or exception the future has; where the system has no thread more, the work is done when
/// it is asked for. The future's destructor waits for the work.
template <class Work>
auto begun(const Work& work) {
  try {
    return std::async(std::launch::async, work);
  } catch (const std::system_error&) {
    return std::async(std::launch::deferred, work);
  }
}

}  // namespace weir
