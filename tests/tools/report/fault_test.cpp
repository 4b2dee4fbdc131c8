#include "tools/report/fault.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <system_error>

namespace weir::fault_test {
namespace {

TEST(Fault, NoMemory_IsNoInternalFault) {
  const Fault fault = fault_of(std::bad_alloc(), "--memory");
  EXPECT_EQ(fault.message, "out of memory; free some, or use a smaller --memory");
  EXPECT_EQ(fault.exit_code, 1);
}

TEST(Fault, NoMoreThreads_IsToldByTheSystemAndByOneTbb) {
  const std::system_error of_system(std::make_error_code(std::errc::resource_unavailable_try_again));
  const std::runtime_error of_tbb("pthread_create has failed: Resource temporarily unavailable");
  for (const std::exception* error :
       {static_cast<const std::exception*>(&of_system), static_cast<const std::exception*>(&of_tbb)}) {
    const Fault fault = fault_of(*error, "--memory");
    EXPECT_EQ(fault.message,
              "no more threads can be started; raise the limit of processes (ulimit -u) or of address space (ulimit "
              "-v), or end some");
    EXPECT_EQ(fault.exit_code, 5);
  }
}

TEST(Fault, AnythingElse_IsAnInternalFault) {
  const Fault fault = fault_of(std::logic_error("a leaf twice"), "--memory");
  EXPECT_EQ(fault.message, "internal fault: a leaf twice; please report it");
  EXPECT_EQ(fault.exit_code, 1);
  const std::system_error other(std::make_error_code(std::errc::bad_file_descriptor));
  EXPECT_EQ(fault_of(other, "--memory").exit_code, 1);
}

}  // namespace
}  // namespace weir::fault_test
