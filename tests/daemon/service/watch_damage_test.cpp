// Tests a state file that is damaged while the service runs: the service ends, and the next start rebuilds the file.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "daemon/store/job_store.h"
#include "format/base/text.h"
#include "tests/daemon/support/service_harness.h"

namespace weir::watch_damage_test {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using Names = std::vector<std::string>;

// Adds more jobs than SQLite keeps in memory, so that the damaged part is read from disk.
void fill_state_file(const ServiceHarness& service) {
  JobStore store(service.path("weir.db"));
  store.together([&] {
    for (int i = 0; i < 20'000; ++i) {
      const std::string source = service.in(cat(std::string(200, 'x'), i, ".h5"));
      store.cancel(store.observe(service.in(), source, {}, "").job.id);
    }
  });
}

// Damages the whole file but its header, which shows the owning program.
void damage_state_file(const ServiceHarness& service) {
  const auto size = fs::file_size(service.path("weir.db"));
  ASSERT_GT(size, 8U << 20U);
  constexpr std::size_t kHeader = 100;  // bytes
  std::fstream file(service.path("weir.db"), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(kHeader);
  file << std::string(size - kHeader, 'x');
}

void expect_end(ServiceHarness& service) {
  CommandResult end;
  EXPECT_EQ(service.wait(&end), 5);
  EXPECT_EQ(end.err, cat("weir: ", service.path("weir.db"),
                         ": cannot use the state: database disk image is malformed; start again, then it is moved "
                         "aside and rebuilt\n"));
  EXPECT_EQ(service.logged("error end reason="), 1U) << service.log();
}

// Reads all jobs, so that no other page stays in memory.
void read_all_jobs(const ServiceHarness& service) { EXPECT_EQ(service.get("/api/jobs?text=nothing")["total"], 0); }

TEST(WatchDamage, FoundWithNewFiles_EndsTheServiceAndIsRebuilt) {
  ServiceHarness service;
  fill_state_file(service);
  service.start();
  damage_state_file(service);
  for (int i = 0; i < 20 && service.running(); ++i) {
    service.add(cat("v", i));
    std::this_thread::sleep_for(milliseconds(50));
  }
  expect_end(service);
  for (int i = 0; i < 20; ++i) service.add(cat("v", i));
  service.start();
  ASSERT_TRUE(service.eventually_done(20)) << service.log();
  EXPECT_TRUE(fs::exists(service.path("weir.db.corrupt-1")));
  EXPECT_EQ(service.leftovers(), Names{});
}

TEST(WatchDamage, FoundByAReload_EndsTheService) {
  ServiceHarness service;
  fill_state_file(service);
  service.start();
  read_all_jobs(service);
  damage_state_file(service);
  service.signal(SIGHUP);
  expect_end(service);
  EXPECT_EQ(service.logged("reload-rejected"), 0U) << service.log();
}

TEST(WatchDamage, FoundByARequest_EndsTheServiceWithoutAnAnswer) {
  ServiceHarness service;
  fill_state_file(service);
  service.start();
  read_all_jobs(service);
  damage_state_file(service);
  EXPECT_TRUE(service.get("/api/jobs?text=nothing").is_discarded());
  expect_end(service);
}

}  // namespace
}  // namespace weir::watch_damage_test
