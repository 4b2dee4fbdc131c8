#include "daemon/store/disk_turns.h"

#include <chrono>
#include <utility>

namespace weir {
namespace {

constexpr std::chrono::milliseconds kBetween{1};

}  // namespace

void DiskTurns::take(std::function<void()> work) {
  queue_.push_back(std::move(work));
  if (queue_.size() == 1) await_next();
}

void DiskTurns::await_next() {
  timer_.expires_at(next_);
  timer_.async_wait([this](boost::system::error_code error) {
    if (!error) run_next();
  });
}

// The piece stays in the queue while it runs, so that a call of take() from within it queues behind it.
void DiskTurns::run_next() {
  queue_.front()();
  queue_.pop_front();
  next_ = boost::asio::steady_timer::clock_type::now() + kBetween;
  if (!queue_.empty()) await_next();
}

}  // namespace weir
