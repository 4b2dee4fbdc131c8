#include "tools/report/fault.h"

#include <new>
#include <system_error>

#include "compressor/plan/startable_threads.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

bool says_no_thread(const std::exception& error) {
  if (const auto* of_system = dynamic_cast<const std::system_error*>(&error)) {
    return of_system->code() == std::errc::resource_unavailable_try_again;
  }
  return std::string_view(error.what()).starts_with("pthread_create has failed");  // oneTBB's message
}

}  // namespace

Fault fault_of(const std::exception& error, std::string_view smaller) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return {cat("out of memory; free some, or use a smaller ", smaller), static_cast<int>(ErrorKind::internal)};
  }
  if (says_no_thread(error)) return {kNoMoreThreads, static_cast<int>(ErrorKind::io)};
  return {cat("internal fault: ", error.what(), "; please report it"), static_cast<int>(ErrorKind::internal)};
}

}  // namespace weir
