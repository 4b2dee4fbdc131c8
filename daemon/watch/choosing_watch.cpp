#include "daemon/watch/choosing_watch.h"

#include <boost/asio/post.hpp>
#include <utility>

#include "daemon/watch/file_system_kind.h"
#include "daemon/watch/inotify.h"
#include "daemon/watch/inotify_watch.h"
#include "daemon/watch/poll_watch.h"
#include "daemon/watch/source_table.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

/// Chooses the method when the directory is there and each time it comes back. The table of known files passes from
/// one method to the other.
class ChoosingWatch final : public DirectoryWatch {
 public:
  ChoosingWatch(boost::asio::io_context& io, const WatchConfig& config, WatchListener listener, OpenInotify open)
      : io_(io),
        config_(config),
        listener_(std::move(listener)),
        open_(std::move(open)),
        table_(config, {[this](const FileEvent& event) { pass_on(event); }, listener_.notice}) {
    use(choice());
  }

  WatchMethod method() const override { return watch_->method(); }
  bool up() const override { return watch_->up(); }
  WatchFigures figures() const override { return watch_->figures(); }
  void choose_again() override {
    gave_up_ = false;
    use(choice());
  }

 private:
  void pass_on(const FileEvent& event) {
    listener_.event(event);
    // The new directory may be on another file system. The watch is replaced later, because it is the caller of this
    // function.
    if (event.kind == FileEventKind::root_back) later([this] { use(choice()); });
  }

  template <typename Task>
  void later(Task task) {
    boost::asio::post(io_, [task, alive = std::weak_ptr(alive_)] {
      if (!alive.expired()) task();
    });
  }

  WatchMethod choice() {
    if (gave_up_) return WatchMethod::poll;
    if (config_.watch != WatchMethod::automatic) return config_.watch;
    try {
      const FileSystemKind kind = file_system_kind(config_.directory);
      if (kind.sees_all_changes) return WatchMethod::inotify;
      polling_because(cat("lies on ", kind.name, ", where inotify does not see what other machines do"));
      return WatchMethod::poll;
    } catch (const Error&) {
      return WatchMethod::inotify;  // the directory is missing; the method is chosen again when it is back
    }
  }

  void polling_because(const std::string& reason) {
    if (watch_ != nullptr && watch_->method() == WatchMethod::poll) return;
    later([this, line = cat(config_.directory, ": ", reason, "; it is looked at every ", config_.poll_interval_s,
                            " s instead")] { listener_.notice(line); });
  }

  void use(WatchMethod method) {
    if (watch_ != nullptr && watch_->method() == method) return;
    if (method == WatchMethod::poll) {
      watch_ = std::make_unique<PollWatch>(io_, table_);
      return;
    }
    watch_ = std::make_unique<InotifyWatch>(io_, table_, open_, [this](const std::string& reason) {
      gave_up_ = true;
      polling_because(reason);
      later([this] { use(WatchMethod::poll); });
    });
  }

  boost::asio::io_context& io_;
  WatchConfig config_;
  WatchListener listener_;
  OpenInotify open_;
  SourceTable table_;
  bool gave_up_ = false;
  std::unique_ptr<DirectoryWatch> watch_;
  std::shared_ptr<void> alive_ = std::make_shared<char>();
};

}  // namespace

std::unique_ptr<DirectoryWatch> make_directory_watch(boost::asio::io_context& io, const WatchConfig& config,
                                                     WatchListener listener) {
  return make_directory_watch(io, config, std::move(listener), open_system_inotify);
}

std::unique_ptr<DirectoryWatch> make_directory_watch(boost::asio::io_context& io, const WatchConfig& config,
                                                     WatchListener listener, OpenInotify open_inotify) {
  return std::make_unique<ChoosingWatch>(io, config, std::move(listener), std::move(open_inotify));
}

}  // namespace weir
