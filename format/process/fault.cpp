#include "format/process/fault.h"

#include <new>
#include <string_view>
#include <system_error>

namespace weir {

bool says_no_thread(const std::exception& error) {
  if (const auto* of_system = dynamic_cast<const std::system_error*>(&error)) {
    return of_system->code() == std::errc::resource_unavailable_try_again;
  }
  return std::string_view(error.what()).starts_with("pthread_create has failed");  // oneTBB's message
}

Error fault_of(const std::exception& error, const Message& smaller) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return {ErrorKind::internal, compose("out of memory; free some, or use a smaller ", smaller)};
  }
  if (says_no_thread(error)) return {ErrorKind::io, kNoMoreThreads};
  return {ErrorKind::internal, cat("internal fault: ", error.what(), "; please report it")};
}

Error error_in_flight() {
  try {
    throw;
  } catch (const Error& error) {
    return error;
  } catch (const std::exception& other) {
    return fault_of(other);
  }
}

}  // namespace weir
