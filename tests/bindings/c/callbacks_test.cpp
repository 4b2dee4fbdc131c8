// Exceptions that callbacks of a C++ program let out.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "bindings/c/conversion_options.h"
#include "bindings/c/status.h"

namespace weir::c_callbacks_test {
namespace {

/// Returns the status and message of a conversion that begins a pass and tells a notice.
weir_error error_of(const weir_convert_options& options) {
  weir_error error{};
  c::guarded(&error, [&] {
    c::Callbacks callbacks(options);
    const ConversionControl control = callbacks.control();
    control.pass_started("survey", 100);
    control.pass_advanced(50);
    if (control.notice) control.notice("a line");
  });
  return error;
}

[[noreturn]] void let_out() { throw std::runtime_error("step 7: a particle left the box"); }

TEST(CCallbacks, ExceptionOfACallback_IsToldAsTheProgramsOwn) {
  const std::string text = " let an exception out, which none may: step 7: a particle left the box";
  weir_convert_options progress{};
  progress.progress = [](void*, const char*, std::uint64_t, std::uint64_t) { let_out(); };
  EXPECT_EQ(error_of(progress).message, "the callback progress" + text);
  EXPECT_EQ(error_of(progress).status, WEIR_ERROR_INTERNAL);
  weir_convert_options cancel{};
  cancel.cancel = [](void*) -> int { let_out(); };
  EXPECT_EQ(error_of(cancel).message, "the callback cancel" + text);
  weir_convert_options notice{};
  notice.notice = [](void*, const char*) { let_out(); };
  EXPECT_EQ(error_of(notice).message, "the callback notice" + text);
}

TEST(CCallbacks, LackOfMemoryInACallback_IsNotToldAsWeirs) {
  weir_convert_options cancel{};
  cancel.cancel = [](void*) -> int { throw std::bad_alloc(); };
  EXPECT_STREQ(error_of(cancel).message, "the callback cancel let an exception out, which none may: std::bad_alloc");
}

TEST(CCallbacks, WhatIsNoStdException_IsToldWithoutAText) {
  weir_convert_options cancel{};
  cancel.cancel = [](void*) -> int { throw 7; };
  EXPECT_STREQ(error_of(cancel).message, "the callback cancel let an exception out, which none may");
}

}  // namespace
}  // namespace weir::c_callbacks_test
