#include "daemon/jobs/process_usage.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <future>
#include <thread>

namespace weir::process_usage_test {
namespace {

TEST(ProcessUsage, CountsDescriptorsAndThreads) {
  const ProcessUsage before = process_usage();
  const int descriptor = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(descriptor, 0);
  std::promise<void> end;
  std::thread thread([&] { end.get_future().wait(); });
  const ProcessUsage during = process_usage();
  end.set_value();
  thread.join();
  ::close(descriptor);
  EXPECT_EQ(during.open_descriptors, before.open_descriptors + 1);
  EXPECT_EQ(during.threads, before.threads + 1);
  EXPECT_GT(during.resident_bytes, std::uint64_t{1} << 20);
}

}  // namespace
}  // namespace weir::process_usage_test
