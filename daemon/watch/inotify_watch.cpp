#include "daemon/watch/inotify_watch.h"

#include <sys/inotify.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <set>
#include <system_error>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kRootInterval{1000};
constexpr std::chrono::minutes kTreeLookInterval{5};
/// Time between two readings of the queue. Events of one file are merged within it, so that a busy writer costs
/// little.
constexpr milliseconds kBatchTime{20};
/// Wait after an overflow, because a storm of events goes on for a while.
constexpr milliseconds kAfterOverflow{100};
constexpr std::size_t kReadsPerBatch = 32;
constexpr std::size_t kBufferBytes = std::size_t{64} << 10U;

bool same_directory(const std::string& a, const std::string& b) {
  struct stat first {};
  struct stat second {};
  return ::stat(a.c_str(), &first) == 0 && ::stat(b.c_str(), &second) == 0 && first.st_dev == second.st_dev &&
         first.st_ino == second.st_ino;
}

}  // namespace

InotifyWatch::InotifyWatch(boost::asio::io_context& io, SourceTable& table, OpenInotify open, GiveUp give_up)
    : table_(table),
      open_(std::move(open)),
      give_up_(std::move(give_up)),
      stream_(io),
      look_(table, [this](const std::string& directory) { enter(directory); }),
      root_timer_(io),
      look_timer_(io),
      batch_timer_(io) {
  after(root_timer_, milliseconds(0), &InotifyWatch::look_at_root);
}

InotifyWatch::~InotifyWatch() { close(State::absent); }

void InotifyWatch::after(boost::asio::steady_timer& timer, milliseconds delay, void (InotifyWatch::*next)()) {
  timer.expires_after(delay);
  timer.async_wait([this, next, alive = std::weak_ptr(alive_)](boost::system::error_code error) {
    if (error || alive.expired()) return;
    (this->*next)();
  });
}

void InotifyWatch::fail(std::string reason) {
  if (state_ == State::failed) return;
  failure_ = std::move(reason);
  close(State::failed);
  after(root_timer_, milliseconds(0), &InotifyWatch::report_failure);
}

void InotifyWatch::report_failure() { give_up_(failure_); }

void InotifyWatch::close(State next) {
  batch_timer_.cancel();
  look_timer_.cancel();
  if (stream_.is_open()) stream_.release();  // cancels the wait; inotify_ closes the descriptor
  inotify_.reset();
  directories_.clear();
  watches_.clear();
  changes_.clear();
  look_.clear();
  looking_ = looking_at_all_ = false;
  state_ = next;
}

void InotifyWatch::start() {
  close(State::absent);
  try {
    inotify_ = open_();
  } catch (const Error& error) {
    return fail(error.what());
  }
  boost::system::error_code error;
  stream_.assign(inotify_->descriptor(), error);
  if (error) {
    return fail(
        cat("inotify: its events cannot be waited for (the limit is fs.epoll.max_user_watches): ", error.message()));
  }
  look_at_all(false);
  await_events();
}

void InotifyWatch::look_at_root() {
  if (state_ == State::failed) return;
  switch (table_.look_at_root()) {
    case SourceTable::Root::missing:
      close(State::absent);
      break;
    case SourceTable::Root::another:
      start();
      break;
    case SourceTable::Root::same:
      if (state_ == State::absent) {  // another kind of watch was used before
        start();
      } else if (state_ == State::watching && !looking_ && (!watches_.contains({}) || look_is_due())) {
        look_at_all(true);
      }
      break;
  }
  if (state_ != State::failed) after(root_timer_, kRootInterval, &InotifyWatch::look_at_root);
}

bool InotifyWatch::look_is_due() const { return std::chrono::steady_clock::now() - looked_at_all_ > kTreeLookInterval; }

void InotifyWatch::look_at_all(bool events_tell) {
  table_.begin_look(events_tell);
  state_ = State::scanning;
  looking_at_all_ = true;
  look_.add({});
  look_on();
}

void InotifyWatch::look_on() {
  if (std::exchange(looking_, true)) return;
  after(look_timer_, milliseconds(0), &InotifyWatch::step);
}

void InotifyWatch::step() {
  const bool more = look_.step();
  if (!is_open()) return;  // it failed during the step
  if (more) return after(look_timer_, milliseconds(0), &InotifyWatch::step);
  looking_ = false;
  if (!std::exchange(looking_at_all_, false)) return;
  if (state_ == State::scanning) state_ = State::watching;
  table_.end_look();
  looked_at_all_ = std::chrono::steady_clock::now();
}

void InotifyWatch::enter(const std::string& directory) {
  if (!is_open()) return;
  const std::string path = table_.absolute(directory);
  const int watch = inotify_->add(path);
  if (watch < 0) {
    const int error = -watch;
    // The directory was removed or replaced, which is an event of its own; or it is unreachable, which the listing
    // reports.
    if (error == ENOENT || error == ENOTDIR || error == ELOOP || error == EACCES || error == ENAMETOOLONG) return;
    return fail(error == ENOSPC ? cat("inotify watches no further directory (the limit is fs.inotify.max_user_watches)")
                                : cat("inotify cannot watch ", path, ": ", std::generic_category().message(error)));
  }
  const auto [at, is_new] = directories_.try_emplace(watch, directory);
  if (!is_new &&
      at->second != directory) {  // the directory had another name; the event of that name's removal is still to come
    const std::string before = std::exchange(at->second, directory);
    if (same_directory(table_.absolute(before), path)) {
      return fail(
          cat(table_.absolute(before), " and ", path, " are one directory, which inotify tells under one name"));
    }
    if (const auto old = watches_.find(before); old != watches_.end() && old->second == watch) watches_.erase(old);
  }
  watches_[directory] = watch;
}

void InotifyWatch::leave(const std::string& directory) {
  look_.leave(directory);
  const std::string below = cat(directory, '/');
  for (auto at = watches_.lower_bound(directory); at != watches_.end() && at->first.starts_with(directory);) {
    if (at->first != directory && !at->first.starts_with(below)) {
      ++at;
      continue;
    }
    inotify_->remove(at->second);
    directories_.erase(at->second);
    at = watches_.erase(at);
  }
}

void InotifyWatch::await_events() {
  stream_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                     [this, alive = std::weak_ptr(alive_)](boost::system::error_code error) {
                       if (error || alive.expired()) return;
                       read_events();
                     });
}

void InotifyWatch::read_events() {
  alignas(inotify_event) std::array<std::byte, kBufferBytes> buffer;
  for (std::size_t reads = 0; reads < kReadsPerBatch && is_open(); ++reads) {
    std::size_t bytes = 0;
    try {
      bytes = inotify_->read(buffer);
    } catch (const Error& error) {
      return fail(error.what());
    }
    if (bytes == 0) break;
    for (std::size_t at = 0; at < bytes && is_open();) {
      inotify_event event{};
      std::memcpy(&event, buffer.data() + at, sizeof event);
      const char* name = reinterpret_cast<const char*>(buffer.data() + at + sizeof event);
      take(event, std::string_view(name, ::strnlen(name, event.len)));
      at += sizeof event + event.len;
    }
  }
  deliver();
  if (!is_open()) return;
  if (state_ == State::lost) return after(batch_timer_, kAfterOverflow, &InotifyWatch::start);
  after(batch_timer_, kBatchTime, &InotifyWatch::await_events);
}

void InotifyWatch::take(const inotify_event& event, std::string_view name) {
  if ((event.mask & IN_Q_OVERFLOW) != 0) {
    if (std::exchange(state_, State::lost) != State::lost) table_.overflowed();
    return;
  }
  const auto at = directories_.find(event.wd);
  if (at == directories_.end()) return;  // the directory was left before
  const std::string directory = at->second;
  if (name.empty()) {
    if (directory.empty()) {  // look_at_root() notices the end of the root itself
      after(root_timer_, milliseconds(0), &InotifyWatch::look_at_root);
    } else if ((event.mask & IN_UNMOUNT) != 0) {
      state_ = State::lost;  // the directories below the mount point must be watched now: begin anew
    }
    if ((event.mask & IN_IGNORED) != 0) {
      if (const auto own = watches_.find(directory); own != watches_.end() && own->second == event.wd) {
        watches_.erase(own);
      }
      directories_.erase(at);
    }
    return;
  }
  const std::string path = directory.empty() ? std::string(name) : cat(directory, '/', name);
  (event.mask & IN_ISDIR) != 0 ? take_directory(event.mask, path) : take_file(event.mask, path);
}

void InotifyWatch::take_directory(std::uint32_t mask, const std::string& path) {
  if (!table_.filter().enters_directory(path)) return;
  deliver();  // keeps the order of the events
  if ((mask & (IN_MOVED_FROM | IN_DELETE)) != 0) {
    leave(path);
    table_.removed_below(path);
  }
  if ((mask & IN_ATTRIB) != 0 && watches_.contains(path)) return;  // the directory was readable before
  // Also after a removal: another directory may already have this name, and its event may have come before.
  look_.add(path);
  look_on();
}

void InotifyWatch::take_file(std::uint32_t mask, const std::string& path) {
  if (!table_.wants(path)) return;
  if ((mask & (IN_CREATE | IN_MOVED_TO | IN_ATTRIB)) != 0) {
    struct stat status {};
    if (::lstat(table_.absolute(path).c_str(), &status) == 0 && S_ISLNK(status.st_mode)) {
      deliver();
      return look_.look_at(path);
    }
  }
  if ((mask & IN_CREATE) != 0) changes_.emplace_back(FileEventKind::created, path);
  if ((mask & IN_MODIFY) != 0) changes_.emplace_back(FileEventKind::written, path);
  if ((mask & IN_ATTRIB) != 0) changes_.emplace_back(FileEventKind::permitted, path);
  if ((mask & IN_CLOSE_WRITE) != 0) changes_.emplace_back(FileEventKind::closed, path);
  if ((mask & IN_MOVED_TO) != 0) changes_.emplace_back(FileEventKind::moved_in, path);
  if ((mask & (IN_MOVED_FROM | IN_DELETE)) != 0) changes_.emplace_back(FileEventKind::removed, path);
}

// Delivers the changes. If a change of a file came several times, only the last one is delivered.
void InotifyWatch::deliver() {
  std::set<Change> told;
  std::vector<Change> last;
  std::reverse(changes_.begin(), changes_.end());
  for (Change& change : changes_) {
    if (told.insert(change).second) last.push_back(std::move(change));
  }
  changes_.clear();
  std::reverse(last.begin(), last.end());
  for (const auto& [kind, path] : last) {
    if (kind != FileEventKind::removed) {
      table_.happened(kind, path);
      continue;
    }
    table_.removed(path);
    look_.look_at(path);  // another file may already have this name, and its event may have come before
  }
}

}  // namespace weir
