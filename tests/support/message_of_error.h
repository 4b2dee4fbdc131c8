// Returns the message of the error that an action throws.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "format/base/error.h"

namespace weir {

/// Runs `action`, which must throw an Error of `kind`, and returns its message.
template <typename Action>
std::string message_of_error(ErrorKind kind, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

}  // namespace weir
