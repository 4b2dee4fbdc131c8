#include "daemon/watch/store_look.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string_view>
#include <system_error>

#include "daemon/store/file_identity.h"
#include "format/base/mix_bits.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::size_t kFilesAtOnce = 1024;
constexpr int kOpenDirectory = O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NONBLOCK;

std::uint64_t mixed(std::uint64_t value) { return mix_bits(value + kGoldenGamma); }

std::uint64_t nanoseconds(const struct timespec& time) {
  return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000U + static_cast<std::uint64_t>(time.tv_nsec);
}

std::string words(int error) { return std::generic_category().message(error); }

}  // namespace

bool StoreLook::step() {
  if (!std::exchange(begun_, true) && !begin()) return false;
  for (std::size_t n = 0; n < kFilesAtOnce; ++n) {
    if (levels_.empty()) return false;
    errno = 0;
    const dirent* const entry = ::readdir(levels_.back().stream.get());
    if (entry == nullptr) {
      if (errno != 0) return fail("", cat("cannot be listed to its end: ", words(errno)));
      path_.resize(levels_.back().path_length);
      levels_.pop_back();
      continue;
    }
    const char* const name = static_cast<const char*>(entry->d_name);
    if (std::string_view(name) == "." || std::string_view(name) == "..") continue;
    if (!look_at(name)) return false;
  }
  return true;
}

bool StoreLook::begin() {
  const int root = ::open(path_.c_str(), kOpenDirectory);
  struct stat status {};
  if (root >= 0 && ::fstat(root, &status) == 0) linked_.insert({status.st_dev, status.st_ino});
  return root >= 0 ? hold(root, "") : fail("", cat("cannot be listed: ", words(errno)));
}

bool StoreLook::look_at(const char* name) {
  const int directory = ::dirfd(levels_.back().stream.get());
  struct stat status {};
  if (::fstatat(directory, name, &status, AT_SYMLINK_NOFOLLOW) != 0) {
    return says_missing(errno) || fail(name, cat("cannot be looked at: ", words(errno)));
  }
  const bool linked = S_ISLNK(status.st_mode);
  if (linked) {  // a link without a target yet is looked at itself
    struct stat target {};
    if (::fstatat(directory, name, &target, 0) == 0) {
      status = target;
    } else if (!says_missing(errno) && errno != EACCES) {
      return fail(name, cat("cannot be looked at: ", words(errno)));
    }
  }
  add(status);
  return !S_ISDIR(status.st_mode) || enter(name, status, linked);
}

void StoreLook::add(const struct stat& status) {
  std::uint64_t state = mixed(status.st_ino ^ mixed(status.st_dev));
  for (const std::uint64_t part :
       {static_cast<std::uint64_t>(status.st_size), nanoseconds(status.st_mtim), nanoseconds(status.st_ctim)}) {
    state = mixed(state ^ part);
  }
  found_.states += state;
  if (S_ISDIR(status.st_mode)) return;
  ++found_.files;
  if (S_ISREG(status.st_mode)) found_.bytes += static_cast<std::uint64_t>(status.st_size);
}

bool StoreLook::enter(const char* name, const struct stat& status, bool linked) {
  if (linked && !linked_.insert({status.st_dev, status.st_ino}).second) return true;
  if (linked_.size() > kMostLinked) return fail(name, cat("is one of more than ", kMostLinked, " linked directories"));
  if (levels_.size() == kMostLevels) return fail(name, cat("lies deeper than ", kMostLevels, " directories"));
  const int directory =
      ::openat(::dirfd(levels_.back().stream.get()), name, kOpenDirectory | (linked ? 0 : O_NOFOLLOW));
  if (directory >= 0) return hold(directory, name);
  return says_missing(errno) || errno == EACCES || fail(name, cat("cannot be listed: ", words(errno)));
}

bool StoreLook::hold(int directory, const char* name) {
  DIR* const stream = ::fdopendir(directory);
  if (stream == nullptr) {
    const int error = errno;
    ::close(directory);
    return fail(name, cat("cannot be listed: ", words(error)));
  }
  levels_.push_back({std::unique_ptr<DIR, CloseDirectory>(stream), path_.size()});
  if (*name != '\0') path_ += cat('/', name);
  return true;
}

bool StoreLook::fail(const char* name, const std::string& what) {
  const std::string path = *name == '\0' ? path_ : cat(path_, '/', name);
  const std::string inside = path.substr(std::min(path.size(), root_length_ + 1));
  fault_ = inside.empty() ? what : cat(inside, ' ', what);
  levels_.clear();
  return false;
}

}  // namespace weir
