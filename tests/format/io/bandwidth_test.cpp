#include "format/io/bandwidth.h"

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
    return {[this] { return now_; },
            [this](TokenBucket::Time::duration time) {
              naps_.push_back(time);
              now_ += time;
              if (cancel_at_ && now_ >= *cancel_at_) cancel_ = true;
            }};
  }

  TokenBucket::Time start_ = TokenBucket::Time() + 1000h;
  TokenBucket::Time now_ = start_;
  std::vector<TokenBucket::Time::duration> naps_;
  std::atomic<bool> cancel_{false};
  std::optional<TokenBucket::Time> cancel_at_;
};

TEST_F(BandwidthTest, WaitsInNapsUntilTheBytesAreWithinTheLimit) {
  Bandwidth bandwidth(1000, &cancel_, clock());
  bandwidth.spend(100);  // a tenth of a second's
  EXPECT_EQ(naps_.size(), 0U);
  bandwidth.spend(250);
  EXPECT_EQ(naps_, (std::vector<TokenBucket::Time::duration>{100ms, 100ms, 50ms}));
  EXPECT_EQ(now_, start_ + 250ms);
  bandwidth.spend(750);
  EXPECT_EQ(now_, start_ + 1s);
}

TEST_F(BandwidthTest, ACancellationEndsTheWaiting) {
  Bandwidth bandwidth(1, &cancel_, clock());
  cancel_at_ = start_ + 300ms;
  bandwidth.spend(1'000'000);
  EXPECT_EQ(now_, start_ + 300ms);
  bandwidth.spend(1'000'000);
  EXPECT_EQ(now_, start_ + 300ms) << "what is left to do waits no more";
}

}  // namespace
}  // namespace weir::bandwidth_test
