#include "format/process/fault.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <system_error>

namespace weir::fault_test {
namespace {

TEST(Fault, NoMemory_IsNoInternalFault) {
  const Error fault = fault_of(std::bad_alloc());
  EXPECT_STREQ(fault.what(), "out of memory; free some, or use a smaller --memory");
  EXPECT_EQ(fault.exit_code(), 1);
  EXPECT_STREQ(fault_of(std::bad_alloc(), "picture").what(), "out of memory; free some, or use a smaller picture");
}

TEST(Fault, NoMoreThreads_IsToldByTheSystemAndByOneTbb) {
  const std::system_error of_system(std::make_error_code(std::errc::resource_unavailable_try_again));
  const std::runtime_error of_tbb("pthread_create has failed: Resource temporarily unavailable");
  for (const std::exception* error :
       {static_cast<const std::exception*>(&of_system), static_cast<const std::exception*>(&of_tbb)}) {
    const Error fault = fault_of(*error);
    EXPECT_STREQ(fault.what(),
                 "no more threads can be started; raise the limit of processes (ulimit -u) or of address space (ulimit "
                 "-v), or end some");
    EXPECT_EQ(fault.exit_code(), 5);
  }
}

TEST(Fault, AnythingElse_IsAnInternalFault) {
  const Error fault = fault_of(std::logic_error("a leaf twice"));
  EXPECT_STREQ(fault.what(), "internal fault: a leaf twice; please report it");
  EXPECT_EQ(fault.exit_code(), 1);
  const std::system_error other(std::make_error_code(std::errc::bad_file_descriptor));
  EXPECT_EQ(fault_of(other).exit_code(), 1);
}

TEST(ErrorInFlight, IsTheErrorItselfOrTheFaultOfWhatWasThrown) {
  const auto in_flight_of = [](const auto& thrown) {
    try {
      throw thrown;
    } catch (...) {
      return error_in_flight();
    }
  };
  const Error full = in_flight_of(Error(ErrorKind::io, "a.nvdb: cannot write"));
  EXPECT_EQ(full.kind(), ErrorKind::io);
  EXPECT_STREQ(full.what(), "a.nvdb: cannot write");
  EXPECT_STREQ(in_flight_of(std::bad_alloc()).what(), "out of memory; free some, or use a smaller --memory");
  const std::system_error no_thread(std::make_error_code(std::errc::resource_unavailable_try_again));
  EXPECT_EQ(in_flight_of(no_thread).kind(), ErrorKind::io);
  EXPECT_STREQ(in_flight_of(no_thread).what(), kNoMoreThreads);
}

}  // namespace
}  // namespace weir::fault_test
