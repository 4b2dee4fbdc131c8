// How the C functions end: every exception becomes a status and a one-line message.
#pragma once

#include <string>

#include "bindings/c/weir.h"
#include "format/base/error.h"
#include "format/process/float_mode.h"

namespace weir::c {

/// Sets *error, if there is one, and returns `status`.
weir_status end_call(weir_error* error, weir_status status, const char* message) noexcept;
/// Does the same for the exception in flight.
weir_status end_with_exception(weir_error* error) noexcept;

/// Runs `call` in weir's floating-point mode; no exception leaves this function.
template <typename Call>
weir_status guarded(weir_error* error, const Call& call) noexcept {
  const FloatMode mode;
  try {
    call();
  } catch (...) {
    return end_with_exception(error);
  }
  return end_call(error, WEIR_OK, "");
}

Error usage(const std::string& message);

/// Returns `pointer`. Throws Error(usage) if it is null; `name` is the parameter's name.
template <typename T>
T* required(T* pointer, const char* name) {
  if (pointer == nullptr) throw usage(std::string(name) + " is a null pointer");
  return pointer;
}

/// Returns a path. Throws Error(usage) if it is null or empty.
inline const char* required_path(const char* path, const char* name) {
  if (*required(path, name) == '\0') throw usage(std::string(name) + " is empty; name a file");
  return path;
}

}  // namespace weir::c
