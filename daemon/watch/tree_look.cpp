#include "daemon/watch/tree_look.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <string_view>
#include <system_error>

#include "daemon/store/file_identity.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::size_t kEntriesPerStep = 256;

std::string joined(const std::string& directory, std::string_view name) {
  return directory.empty() ? std::string(name) : cat(directory, '/', name);
}

}  // namespace

void TreeLook::leave(const std::string& directory) {
  const auto inside = [below = cat(directory, '/'), &directory](const std::string& path) {
    return path == directory || path.starts_with(below);
  };
  std::erase_if(waiting_, inside);
  if (stream_ != nullptr && inside(directory_)) stream_.reset();
}

void TreeLook::clear() {
  waiting_.clear();
  stream_.reset();
}

void TreeLook::open_next() {
  directory_ = std::move(waiting_.front());
  waiting_.pop_front();
  entering_(directory_);
  // The watched directory may be a link; directories below it may not.
  const int flags = O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NONBLOCK | (directory_.empty() ? 0 : O_NOFOLLOW);
  const int descriptor = ::open(table_.absolute(directory_).c_str(), flags);
  stream_.reset(descriptor < 0 ? nullptr : ::fdopendir(descriptor));
  if (stream_ != nullptr) return;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (error == ENOENT || error == ENOTDIR || error == ELOOP) return;  // removed or replaced meanwhile
  table_.complain(directory_, cat("cannot be listed: ", std::generic_category().message(error),
                                  "; nothing in it is converted until it can"));
}

bool TreeLook::step() {
  for (std::size_t i = 0; i < kEntriesPerStep; ++i) {
    if (stream_ == nullptr) {
      if (waiting_.empty()) return false;
      open_next();
      continue;
    }
    errno = 0;
    const dirent* entry = ::readdir(stream_.get());
    if (entry == nullptr) {
      if (errno == 0) {
        table_.settled(directory_);
      } else {
        table_.complain(directory_, cat("cannot be listed to its end: ", std::generic_category().message(errno)));
      }
      stream_.reset();
      continue;
    }
    const char* name = static_cast<const char*>(entry->d_name);
    const std::string path = joined(directory_, name);
    if (std::string_view(name) == "." || std::string_view(name) == "..") continue;
    if (!table_.wants(path) && !table_.filter().enters_directory(path)) continue;
    struct stat status {};
    if (::fstatat(::dirfd(stream_.get()), name, &status, AT_SYMLINK_NOFOLLOW) == 0) look_at(status, path);
  }
  return stream_ != nullptr || !waiting_.empty();
}

void TreeLook::look_at(const std::string& path) {
  struct stat status {};
  if (::lstat(table_.absolute(path).c_str(), &status) == 0) look_at(status, path);
}

void TreeLook::look_at(const struct stat& status, const std::string& path) {
  if (S_ISDIR(status.st_mode)) {
    if (table_.filter().enters_directory(path)) add(path);
    return;
  }
  if (!table_.wants(path)) return;
  if (S_ISREG(status.st_mode)) return table_.saw(path, identity_of(status));
  if (!S_ISLNK(status.st_mode)) return;
  // A linked directory is looked at only at its real place, if that is in the tree: so there are no loops.
  const auto target = identify(table_.absolute(path));
  if (!target) return;
  const std::string refusal = table_.filter().link_refusal(path);
  if (!refusal.empty()) return table_.complain(path, refusal);
  table_.settled(path);
  table_.saw(path, *target);
}

}  // namespace weir
