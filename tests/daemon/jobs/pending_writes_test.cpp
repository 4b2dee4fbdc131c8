#include "daemon/jobs/pending_writes.h"

#include <gtest/gtest.h>

#include <vector>

#include "daemon/config/config.h"
#include "format/base/text.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_directory.h"

namespace weir::pending_writes_test {
namespace {

class PendingWritesTest : public testing::Test {
 protected:
  ServiceConfig service() const {
    ServiceConfig service;
    service.log_file = directory_ / "log";
    return service;
  }
  std::size_t faults_said() const {
    std::size_t count = 0;
    for (const std::string& line : split(read_file(directory_ / "log"), '\n')) {
      count += line.find(" state-file-fault reason=full") != std::string::npos ? 1 : 0;
    }
    return count;
  }

  TemporaryDirectory directory_;
  EventLog log_{service()};
  PendingWrites writes_{log_};
};

TEST_F(PendingWritesTest, FaultStaysUntilSomethingIsWritten) {
  const Error full(ErrorKind::io, "full");
  writes_.log_fault(full);
  writes_.write();  // there is nothing to write
  EXPECT_EQ(writes_.fault(), "full");
  writes_.log_fault(full);
  EXPECT_EQ(faults_said(), 1U);
  writes_.clear_fault();
  EXPECT_EQ(writes_.fault(), "");
}

TEST_F(PendingWritesTest, StepsThatFail_AreKeptInOrderAndTriedAgain) {
  std::vector<int> done;
  bool has_room = false;
  for (const int step : {1, 2}) {
    writes_.add([&, step] {
      if (!has_room) throw Error(ErrorKind::io, "full");
      done.push_back(step);
    });
  }
  EXPECT_FALSE(writes_.empty());
  EXPECT_EQ(writes_.fault(), "full");
  writes_.clear_fault();
  EXPECT_EQ(writes_.fault(), "full") << "steps are kept";
  has_room = true;
  writes_.write();
  EXPECT_EQ(done, (std::vector<int>{1, 2}));
  EXPECT_EQ(writes_.fault(), "");
  EXPECT_EQ(faults_said(), 1U);
}

}  // namespace
}  // namespace weir::pending_writes_test
