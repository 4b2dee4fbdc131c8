// What a call is refused with.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "format/base/error.h"

namespace weir::test {

/// The message of the Error of that kind that `call` throws; "none" where it throws none.
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
