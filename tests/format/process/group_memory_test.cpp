#include "format/process/group_memory.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "tests/ingest/support/scratch.h"

namespace weir::group_memory_test {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

class GroupMemory : public ::testing::Test {
 protected:
  void list(const std::string& groups) { std::ofstream(scratch_.path("groups")) << groups; }
  // The files of a group of version 2; `limit` may be "max".
  void group2(const std::string& path, const std::string& limit, std::uint64_t used, std::uint64_t cache,
              std::uint64_t shared = 0) {
    write(path, "memory.max", limit);
    write(path, "memory.current", std::to_string(used));
    write(path, "memory.stat",
          "anon " + std::to_string(used - cache) + "\nfile " + std::to_string(cache) + "\nshmem " +
              std::to_string(shared) + "\n");
  }
  void group1(const std::string& path, std::uint64_t limit, std::uint64_t used, std::uint64_t cache) {
    write("memory" + path, "memory.limit_in_bytes", std::to_string(limit));
    write("memory" + path, "memory.usage_in_bytes", std::to_string(used));
    write("memory" + path, "memory.stat", "cache 1\ntotal_cache " + std::to_string(cache) + "\n");
  }
  std::uint64_t room() const { return group_room(scratch_.path("groups"), scratch_.path("mounts")); }

 private:
  void write(const std::string& group, const std::string& name, const std::string& text) {
    const std::string directory = scratch_.path("mounts/" + group);
    std::filesystem::create_directories(directory);
    std::ofstream(directory + "/" + name) << text << "\n";
  }

  Scratch scratch_;
};

TEST_F(GroupMemory, HasNoLimitWithoutGroups) {
  EXPECT_EQ(room(), kUnlimited);
  list("1:cpu:/\n0::/\n");
  EXPECT_EQ(room(), kUnlimited);
}

TEST_F(GroupMemory, IsThatOfTheNarrowestGroupAround) {
  list("0::/job_7/step_0/task\n");
  group2("/job_7/step_0/task", "max", 900, 0);
  group2("/job_7/step_0", "5000", 1000, 400);
  group2("/job_7", "4000", 2000, 100);
  EXPECT_EQ(room(), 2100U);  // of /job_7: 4000 - (2000 - 100)
  group2("/job_7/step_0", "1500", 1000, 400);
  EXPECT_EQ(room(), 900U);
}

TEST_F(GroupMemory, OfAContainerIsThatOfItsRoot) {
  list("0::/machine/elsewhere\n");  // a path of the host, not there in the container
  group2("", "3000", 1000, 500);
  EXPECT_EQ(room(), 2500U);
}

TEST_F(GroupMemory, OfVersionOneIsThatOfTheMemoryController) {
  list("9:name=systemd:/other\n4:cpu,memory:/batch/job\n0::/\n");
  group1("/batch/job", 9'000'000, 2'000'000, 1'000'000);
  group1("", std::numeric_limits<std::int64_t>::max(), 3'000'000, 0);
  EXPECT_EQ(room(), 8'000'000U);
}

TEST_F(GroupMemory, FilesInMemoryAreTaken) {
  list("0::/job\n");
  group2("/job", "5000", 3000, 2500, 700);
  EXPECT_EQ(room(), 3800U);  // 5000 - (3000 - (2500 - 700))
}

TEST_F(GroupMemory, IsNothingBeyondTheLimit) {
  list("0::/full\n");
  group2("/full", "1000", 5000, 200);
  EXPECT_EQ(room(), 0U);
}

}  // namespace
}  // namespace weir::group_memory_test
