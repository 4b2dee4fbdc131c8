#include "daemon/watch/store_quiet.h"

#include <sys/stat.h>

#include <algorithm>
#include <system_error>

#include "format/base/text.h"
#include "ingest/files/input_directory.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFilesAtOnce = 1024;
constexpr std::chrono::nanoseconds kLeastSettle = std::chrono::milliseconds(100);  // settle may be 0

bool names_store(std::string_view component) { return component.size() > 5 && component.ends_with(".zarr"); }

std::string_view directory_of_path(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string_view() : path.substr(0, slash);
}

std::string_view last_of(std::string_view path) { return path.substr(path.find_last_of('/') + 1); }

// Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014 (the mixer of SplitMix64).
std::uint64_t mixed(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15U;
  value = (value ^ value >> 30U) * 0xBF58476D1CE4E5B9U;
  value = (value ^ value >> 27U) * 0x94D049BB133111EBU;
  return value ^ value >> 31U;
}

std::uint64_t nanoseconds(const struct timespec& time) {
  return static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000U + static_cast<std::uint64_t>(time.tv_nsec);
}

}  // namespace

bool is_in_store(std::string_view path) {
  for (std::string_view directory = directory_of_path(path); !directory.empty();
       directory = directory_of_path(directory)) {
    if (names_store(last_of(directory))) return true;
  }
  return false;
}

bool is_store_head(std::string_view path) {
  if (!is_head(path) || is_plotfile_head(path)) return false;
  const std::string_view store = named_by_head(path);
  return names_store(last_of(store)) && !is_in_store(store);
}

StoreQuiet::Answer StoreQuiet::look(Time now) {
  const auto pause = std::chrono::duration_cast<Time::duration>(std::max(settle_, kLeastSettle));
  if (!at_) {
    std::error_code error;
    at_.emplace(directory_, fs::directory_options::skip_permission_denied, error);
    if (error) at_.reset();
    if (error) return {false, now + pause, cat("cannot be listed: ", error.message())};
    found_ = {};
    begun_ = now;
  }
  if (!step()) return {false, now, cat("its files are looked through, ", found_.files, " so far")};
  const bool same = before_ == found_;
  const bool long_enough = same && begun_ - before_end_ >= pause;
  if (long_enough) return {true, {}, {}};
  const bool first = !before_;
  if (!same) {
    before_ = found_;
    before_end_ = now;
  }
  return {false, before_end_ + pause,
          cat("it has ", found_.files, " files, ", format_bytes(found_.bytes),
              first ? ", and may still be written" : ", and changed a moment ago")};
}

// Whether all is looked through. What vanishes meanwhile is a change, which the next look finds.
bool StoreQuiet::step() {
  std::error_code error;
  for (std::size_t n = 0; n < kFilesAtOnce; ++n) {
    if (*at_ == fs::recursive_directory_iterator()) {
      at_.reset();
      return true;
    }
    add((*at_)->path());
    at_->increment(error);
    if (!error) continue;
    at_.reset();
    found_.states = ~found_.states;
    return true;
  }
  return false;
}

void StoreQuiet::add(const fs::path& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return;
  const bool directory = S_ISDIR(status.st_mode);
  std::uint64_t state = mixed(status.st_ino);
  for (const std::uint64_t part :
       {static_cast<std::uint64_t>(status.st_size), nanoseconds(status.st_mtim), nanoseconds(status.st_ctim)}) {
    state = mixed(state ^ part);
  }
  found_.states += state;
  if (directory) return;
  ++found_.files;
  found_.bytes += static_cast<std::uint64_t>(status.st_size);
}

}  // namespace weir
