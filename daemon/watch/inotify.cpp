#include "daemon/watch/inotify.h"

#include <sys/inotify.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/descriptor.h"

namespace weir {
namespace {

constexpr std::uint32_t kEvents = IN_CREATE | IN_MODIFY | IN_CLOSE_WRITE | IN_MOVED_FROM | IN_MOVED_TO | IN_DELETE |
                                  IN_ATTRIB | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR | IN_EXCL_UNLINK;

class SystemInotify final : public Inotify {
 public:
  SystemInotify() : queue_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    if (queue_) return;
    // Not as io_error() says it: the limit may be another than that of open files.
    throw Error(ErrorKind::io, cat("inotify: cannot open a queue (fs.inotify.max_user_instances limits them): ",
                                   std::generic_category().message(errno)));
  }

  int descriptor() const override { return queue_.get(); }

  int add(const std::string& directory) override {
    const int watch = ::inotify_add_watch(queue_.get(), directory.c_str(), kEvents);
    return watch < 0 ? -errno : watch;
  }

  void remove(int watch) override { ::inotify_rm_watch(queue_.get(), watch); }

  std::size_t read(std::span<std::byte> events) override {
    for (;;) {
      const ssize_t got = ::read(queue_.get(), events.data(), events.size());
      if (got >= 0) return static_cast<std::size_t>(got);
      if (errno == EAGAIN) return 0;
      if (errno != EINTR) throw io_error("inotify", "read its queue", errno);
    }
  }

 private:
  Descriptor queue_;
};

}  // namespace

std::unique_ptr<Inotify> open_system_inotify() { return std::make_unique<SystemInotify>(); }

}  // namespace weir
