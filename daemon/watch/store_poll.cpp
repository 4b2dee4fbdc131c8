#include "daemon/watch/store_poll.h"

#include <cstddef>
#include <utility>

#include "daemon/watch/source_identity.h"

namespace weir {
namespace {

constexpr std::size_t kStoresAtOnce = 32;  // in one turn of the event loop, which serves others, too

}  // namespace

StorePoll::StorePoll(boost::asio::io_context& io, const WatchConfig& watch,
                     std::function<void(const std::string& head)> changed)
    : convert_options_(watch.convert_options),
      interval_(watch.poll_interval_s),
      changed_(std::move(changed)),
      timer_(io) {}

void StorePoll::seen(const std::string& head, const FileIdentity& identity) {
  known_.insert_or_assign(head, identity);
  if (!waiting_) wait(interval_);
}

void StorePoll::wait(std::chrono::duration<double> delay) {
  waiting_ = true;
  timer_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(delay));
  timer_.async_wait([this, alive = std::weak_ptr(alive_)](boost::system::error_code error) {
    if (!error && !alive.expired()) look();
  });
}

void StorePoll::look() {
  std::vector<std::string> changed;
  auto at = known_.upper_bound(last_);
  for (std::size_t n = 0; n < kStoresAtOnce && at != known_.end(); ++n, ++at) {
    last_ = at->first;
    const auto now = identify_source(at->first, convert_options_);
    if (now && *now != at->second) changed.push_back(at->first);
  }
  const bool over = at == known_.end();
  if (over) last_.clear();
  waiting_ = false;
  if (!known_.empty()) wait(over ? interval_ : std::chrono::duration<double>(0));
  for (const std::string& head : changed) changed_(head);
}

}  // namespace weir
