#include "format/bandwidth.h"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <vector>

namespace weir::bandwidth_test {
namespace {

using namespace std::chrono_literals;

class BandwidthTest : public testing::Test {
 protected:
  BandwidthClock clock() {
    return {[this] { return now; },
            [this](TokenBucket::Time::duration time) {
              naps.push_back(time);
              now += time;
              if (cancel_at && now >= *cancel_at) cancel = true;
            }};
  }

  TokenBucket::Time start = TokenBucket::Time() + 1000h;
  TokenBucket::Time now = start;
  std::vector<TokenBucket::Time::duration> naps;
  std::atomic<bool> cancel{false};
  std::optional<TokenBucket::Time> cancel_at;
};

TEST_F(BandwidthTest, WaitsInNapsUntilTheBytesAreWithinTheLimit) {
  Bandwidth bandwidth(1000, &cancel, clock());
  bandwidth.spend(100);  // a tenth of a second's
  EXPECT_EQ(naps.size(), 0U);
  bandwidth.spend(250);
  EXPECT_EQ(naps, (std::vector<TokenBucket::Time::duration>{100ms, 100ms, 50ms}));
  EXPECT_EQ(now, start + 250ms);
  bandwidth.spend(750);
  EXPECT_EQ(now, start + 1s);
}

TEST_F(BandwidthTest, ACancellationEndsTheWaiting) {
  Bandwidth bandwidth(1, &cancel, clock());
  cancel_at = start + 300ms;
  bandwidth.spend(1'000'000);
  EXPECT_EQ(now, start + 300ms);
  bandwidth.spend(1'000'000);
  EXPECT_EQ(now, start + 300ms) << "what is left to do waits no more";
}

}  // namespace
}  // namespace weir::bandwidth_test
