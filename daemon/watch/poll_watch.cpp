#include "daemon/watch/poll_watch.h"

namespace weir {

PollWatch::PollWatch(boost::asio::io_context& io, SourceTable& table)
    : table_(table), look_(table, [this](const std::string&) { ++entered_; }), timer_(io) {
  wait({}, &PollWatch::begin);
}

void PollWatch::wait(std::chrono::duration<double> delay, void (PollWatch::*next)()) {
  timer_.expires_after(std::chrono::duration_cast<std::chrono::steady_clock::duration>(delay));
  timer_.async_wait([this, next, alive = std::weak_ptr(alive_)](boost::system::error_code) {
    if (!alive.expired()) (this->*next)();
  });
}

void PollWatch::begin() {
  if (table_.look_at_root() == SourceTable::Root::missing) {
    directories_ = 0;
    return wait(std::chrono::duration<double>(table_.watch().poll_interval_s), &PollWatch::begin);
  }
  table_.begin_look(false);
  entered_ = 0;
  look_.add({});
  step();
}

void PollWatch::step() {
  if (look_.step()) return wait({}, &PollWatch::step);
  table_.end_look();
  directories_ = entered_;
  wait(std::chrono::duration<double>(table_.watch().poll_interval_s), &PollWatch::begin);
}

}  // namespace weir
