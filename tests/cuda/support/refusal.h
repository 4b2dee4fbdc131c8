// Returns the message with which a call is refused.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "format/base/error.h"

namespace weir::test {

/// Returns the message of the Error of kind `kind` that `call` throws; "none" if it throws none.
template <class Call>
std::string refusal(ErrorKind kind, Call call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  return "none";
}

}  // namespace weir::test
