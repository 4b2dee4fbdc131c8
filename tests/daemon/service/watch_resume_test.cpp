// Tests a service that ends in the middle of a large conversion, and the next one, which continues it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "format/base/text.h"
#include "tests/daemon/support/service_harness.h"

namespace weir::watch_resume_test {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

// Returns whether the first leaf is surveyed: reserved space reads as zeros, and no digest is zero.
bool is_begun(const fs::path& rows) {
  std::string row(64, '\0');
  std::ifstream(rows, std::ios::binary).read(row.data(), static_cast<std::streamsize>(row.size()));
  return row != std::string(row.size(), '\0');
}

TEST(WatchResume, ALargeConversionGoesOnAfterAStop) {
  ServiceHarness service("grace = 0\nmemory = \"400MiB\"\nthreads = 1\n", "thumbnails = false\n");
  // A gibibyte that takes no disk space.
  const std::string name = "zeros_1024x1024x1024_uint8";
  write_file(service.path(name), "");
  fs::resize_file(service.path(name), std::uintmax_t{1} << 30U);
  fs::rename(service.path(name), service.in(name + ".raw"));
  const fs::path work = service.out("." + name + ".nvdb.work");

  service.start();
  ASSERT_TRUE(ServiceHarness::eventually([&] { return is_begun(work / "rows"); }));
  EXPECT_EQ(service.stop(), 0);
  ASSERT_FALSE(fs::exists(service.out(name + ".nvdb"))) << "was over before it could be stopped";
  EXPECT_EQ(list_directory(work), (Names{"journal", "rows"}));

  service.start();
  ASSERT_TRUE(service.eventually_done(1));
  const auto job = service.get(cat("/api/jobs/", service.job(name + ".raw")["id"].get<int>()));
  EXPECT_NE(job.value("log_tail", "").find("continues a conversion that was interrupted, survey "), std::string::npos)
      << job;
  EXPECT_EQ(service.job(name + ".raw")["attempts"], 0);
  EXPECT_EQ(service.stop(), 0);
  EXPECT_EQ(list_directory(service.out()), (Names{name + ".nvdb", name + ".nvdb.json"}));
  EXPECT_EQ(service.difference(name + ".raw", name + ".nvdb"), "");
}

}  // namespace
}  // namespace weir::watch_resume_test
