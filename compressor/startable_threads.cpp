#include "compressor/startable_threads.h"

#include <latch>
#include <system_error>
#include <thread>
#include <vector>

namespace weir {

std::size_t startable_threads(std::size_t wanted) {
  std::latch counted(1);  // before the threads, which are joined first
  std::vector<std::jthread> started;
  started.reserve(wanted);
  try {
    while (started.size() < wanted) started.emplace_back([&counted] { counted.wait(); });
  } catch (const std::system_error&) {
    // as many as there are
  } catch (...) {
    counted.count_down();
    throw;
  }
  const std::size_t count = started.size();
  counted.count_down();
  return count;
}

}  // namespace weir
