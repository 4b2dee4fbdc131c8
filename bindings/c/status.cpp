#include "bindings/c/status.h"

#include <exception>
#include <new>

#include "bindings/c/short_text.h"
#include "bindings/c/wording.h"
#include "format/base/printable.h"
#include "format/process/fault.h"

namespace weir::c {

static_assert(WEIR_ERROR_INTERNAL == static_cast<int>(ErrorKind::internal));
static_assert(WEIR_ERROR_USAGE == static_cast<int>(ErrorKind::usage));
static_assert(WEIR_ERROR_INPUT == static_cast<int>(ErrorKind::input));
static_assert(WEIR_ERROR_BUDGET == static_cast<int>(ErrorKind::budget));
static_assert(WEIR_ERROR_IO == static_cast<int>(ErrorKind::io));
static_assert(WEIR_INTERRUPTED == static_cast<int>(ErrorKind::interrupted));

weir_status end_call(weir_error* error, weir_status status, const char* message) noexcept {
  if (error == nullptr) return status;
  error->status = status;
  copy_shortened(message, error->message);
  return status;
}

namespace {

weir_status end_with_error(weir_error* error, const Error& e) {
  try {
    return end_call(error, e.exit_code(), one_line(e.message().worded(c_wording)).c_str());
  } catch (const std::bad_alloc&) {  // no memory for the worded message
    return end_call(error, e.exit_code(), e.what());
  }
}

weir_status end_with_fault(weir_error* error, const std::exception& e) {
  try {
    return end_with_error(error, fault_of(e));
  } catch (const std::bad_alloc&) {
    return end_call(error, WEIR_ERROR_INTERNAL, e.what());
  }
}

}  // namespace

weir_status end_with_exception(weir_error* error) noexcept {
  try {
    throw;
  } catch (const Error& e) {
    return end_with_error(error, e);
  } catch (const std::bad_alloc&) {
    return end_call(error, WEIR_ERROR_INTERNAL, "out of memory; give less memory to weir, or free some");
  } catch (const std::exception& e) {
    return end_with_fault(error, e);
  } catch (...) {
    return end_call(error, WEIR_ERROR_INTERNAL, "a callback let an exception out, which none may");
  }
}

Error usage(const std::string& message) { return {ErrorKind::usage, message}; }

}  // namespace weir::c
